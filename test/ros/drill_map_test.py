#!/usr/bin/env python3
"""The map follows what the scanners see, until it freezes in the middle of a task."""

import sys

import rospy
import rostest

import drill
import harness
from casepush.msg import PushObjectResult


class DrillMapTest(drill.Drill):

    def test_something_unknown_is_seen_and_gone_around(self):
        self.bar_the_way()

        def gets_there():
            """The map shows what is new after some seconds of wall time, soon for this clock."""
            self.start_task()
            return self.finish_task(PushObjectResult.SUCCEEDED, PushObjectResult.NO_PROGRESS,
                                    explanation="holds the robot") == PushObjectResult.SUCCEEDED

        harness.wait_until(gets_there, 60.0, "a map with the box")

    def test_the_map_freezes(self):
        self.start_task()
        self.wait_phase("approach")
        self.relay.scans_frozen = True
        self.finish_task()


if __name__ == "__main__":
    rospy.init_node("drill_map_test")
    rostest.rosrun("casepush", "drill_map", DrillMapTest, sys.argv)
