#!/usr/bin/env python3
"""The map follows what the scanners see, until it freezes in the middle of a task."""

import sys

import rospy
import rostest

import drill


class DrillMapTest(drill.Drill):

    def test_something_unknown_is_seen_before_it_is_met(self):
        self.map.clear()
        self.bar_the_way()
        self.map.wait()
        self.start_task()
        self.finish_task()

    def test_the_map_freezes(self):
        self.start_task()
        self.wait_phase("approach")
        self.relay.scans_frozen = True
        self.finish_task()


if __name__ == "__main__":
    rospy.init_node("drill_map_test")
    rostest.rosrun("casepush", "drill_map", DrillMapTest, sys.argv)
