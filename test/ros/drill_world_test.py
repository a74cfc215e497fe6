#!/usr/bin/env python3
"""The world changes in the middle of a task: somebody moves the chair, bars the way, sits down."""

import sys

import rospy
import rostest
from geometry_msgs.msg import Point

import drill
import harness
from casepush.msg import ObjectLoad, PushObjectResult
from casepush.srv import SetLoad

# Of further tasks, should the first have too few pushes to notice a load by.
MORE_GOALS = ((-1.0, -0.8, -2.0), (1.2, 0.8, 0.5), (-1.0, -0.8, -2.0))


class DrillWorldTest(drill.Drill):

    def test_somebody_moves_the_chair(self):
        self.start_task()
        self.wait_phase("push")
        self.place(chair_1=(-0.3, -1.0, 1.0))
        self.finish_task()

    def test_something_unknown_bars_the_way(self):
        self.bar_the_way()
        self.start_task()
        self.finish_task(PushObjectResult.SUCCEEDED, PushObjectResult.NO_PROGRESS,
                         explanation="holds the robot")
        self.assertTrue(self.has_met_the_box())

    def has_met_the_box(self):
        return any("holds the robot" in m.explanation for _, m in self.reports.all())

    def test_something_unknown_bars_the_way_for_a_while(self):
        self.bar_the_way()
        self.start_task()
        harness.wait_until(self.has_met_the_box, what="a contact")
        self.place(box_1=(4.4, 4.4, 0.0))
        self.finish_task()

    def test_something_unknown_stops_the_chair(self):
        self.start_task()
        self.wait_phase("push")
        self.place(box_1=(1.0, 0.7, 0.7))
        self.finish_task(PushObjectResult.NO_PROGRESS, PushObjectResult.NO_PLAN,
                         PushObjectResult.TIMEOUT)

    def sources_of_noticed(self):
        """The cases that there are copies of for a change that pushes gave away."""
        return {row[0] for row in self.stored("SELECT source_id FROM cases WHERE noticed > 0")}

    def rejected_pushes(self):
        return sum(report.rejected for _, report in self.reports.all())

    def test_somebody_sits_down(self):
        set_load = rospy.ServiceProxy("sim/set_load", SetLoad)
        load = ObjectLoad(id=harness.OBJECT, mass=40.0, centre=Point(0.0, 0.0, 0.0))
        originals = self.observations()
        self.assertEqual(self.sources_of_noticed(), set())
        self.start_task()
        self.wait_phase("push")
        answer = set_load(load)
        self.assertTrue(answer.success, answer.message)
        rejected = 0
        try:
            self.finish_task()
            rejected += self.rejected_pushes()
            for goal in MORE_GOALS:
                if not self.sources_of_noticed():
                    self.start_task(*goal)
                    self.finish_task()
                    rejected += self.rejected_pushes()
        finally:
            load.mass = 0.0
            set_load(load)
        # With few pushes, of which hardly any goes astray, there is nothing to notice.
        self.assertTrue(self.sources_of_noticed() or rejected < 3,
                        f"nobody noticed the load, though {rejected} pushes went astray")
        self.assertLessEqual(self.sources_of_noticed(), originals.keys())
        # The change may be taken for an earlier one by a push or two, which are then taken back.
        stored = self.observations()
        for case, before in originals.items():
            kept = min(len(before), len(stored[case]))
            self.assertEqual(stored[case][:kept], before[:kept])
        lost = sum(len(before) - len(stored[case]) for case, before in originals.items()
                   if len(stored[case]) < len(before))
        self.assertLessEqual(lost, 3)


if __name__ == "__main__":
    rospy.init_node("drill_world_test")
    rostest.rosrun("casepush", "drill_world", DrillWorldTest, sys.argv)
