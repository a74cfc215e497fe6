#!/usr/bin/env python3
"""In the middle of a task detections drop out, transforms freeze and clocks jump."""

import sys

import rospy
import rostest

import drill
import harness
from casepush.msg import PushObjectGoal, PushObjectResult


class DrillSensesTest(drill.Drill):

    def test_half_of_the_detections_drop_out(self):
        self.relay.drop_share = 0.5
        self.start_task()
        self.finish_task()

    def test_a_goal_is_refused_while_transforms_or_odometry_are_frozen(self):
        for frozen, words in (("tf_frozen", "the robot's pose is out of date"),
                              ("odometry_frozen", "odometry ceased")):
            setattr(self.relay, frozen, True)
            began_s = self.motion.wait().header.stamp.to_sec()
            harness.wait_until(lambda t=began_s: self.now() > t + 3.0, what="three seconds")
            self.push_object.send_goal(PushObjectGoal(object_id=harness.OBJECT,
                                                      goal=harness.pose(1.2, 0.8, 0.5)))
            result = harness.result_of(self.push_object)
            self.assertEqual(result.status, PushObjectResult.NOT_READY, result.explanation)
            self.assertIn(words, result.explanation)
            self.relay.mend()
        self.expect_next_task_succeeds()

    def test_transforms_freeze(self):
        self.start_task()
        self.wait_phase("approach")
        self.wait_moving()
        self.relay.tf_frozen = True
        self.finish_task(PushObjectResult.ROBOT_LOST)

    def test_transforms_freeze_for_a_second(self):
        self.start_task()
        self.wait_phase("push")
        self.relay.tf_frozen = True
        frozen_s = self.now()
        harness.wait_until(lambda: self.now() > frozen_s + 1.0, what="a second")
        self.relay.tf_frozen = False
        self.finish_task()

    def test_transforms_come_from_the_future_for_a_second(self):
        self.start_task()
        self.wait_phase("push")
        self.relay.tf_ahead = rospy.Duration(1000)
        began_s = self.now()
        harness.wait_until(lambda: self.now() > began_s + 1.0, what="a second")
        self.relay.mend()
        self.finish_task()

    def test_transforms_come_from_the_future(self):
        self.start_task()
        self.wait_phase("push")
        self.relay.tf_ahead = rospy.Duration(1000)
        self.finish_task(PushObjectResult.STOPPED, explanation="ahead of the clock")
        self.relay.mend()
        self.expect_next_task_succeeds()

    def test_odometry_freezes(self):
        self.start_task()
        self.wait_phase("approach")
        self.wait_moving()
        self.relay.odometry_frozen = True
        self.finish_task(PushObjectResult.ROBOT_LOST)

    def test_clock_jumps_forwards(self):
        self.start_task()
        self.wait_phase("push")
        self.relay.jump(30.0)
        self.finish_task()

    def test_clock_jumps_backwards(self):
        self.start_task()
        self.wait_phase("push")
        self.relay.jump(-8.0)
        self.finish_task(PushObjectResult.STOPPED, explanation="time jumped back")
        self.expect_next_task_succeeds()


if __name__ == "__main__":
    rospy.init_node("drill_senses_test")
    rostest.rosrun("casepush", "drill_senses", DrillSensesTest, sys.argv)
