#!/usr/bin/env python3
"""Nodes are killed in the middle of a task; roslaunch starts them again."""

import os
import signal
import sys

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

import drill
import harness
from casepush.msg import PushObjectResult


class DrillNodesTest(drill.Drill):

    def kill(self, node):
        """Kills a node and waits until it is there again."""
        process = drill.process_of(node)
        os.kill(process, signal.SIGKILL)

        def is_back():
            try:
                return drill.process_of(node) != process
            except OSError:
                return False

        return is_back

    def expect_next_task_succeeds(self):
        self.await_nodes()
        self.start_task()
        result = self.finish_task()
        self.assertEqual(result.status, PushObjectResult.SUCCEEDED, result.explanation)

    def test_only_the_executor_commands_the_base(self):
        publishers = dict(rospy.get_master().getSystemState()[2][0])
        self.assertEqual(publishers["/cmd_vel"], ["/executor_node"])

    def test_killed_planner(self):
        self.start_task()
        self.wait_phase("approach", "dock", "push")
        is_back = self.kill("planner_node")
        result = self.finish_task()
        self.assertEqual(result.status, PushObjectResult.PLANNER_GONE, result.explanation)
        harness.wait_until(is_back, what="a new planner")
        self.expect_next_task_succeeds()

    def test_killed_learner(self):
        self.start_task()
        self.wait_phase("push")
        is_back = self.kill("learner_node")
        result = self.finish_task()
        self.assertEqual(result.status, PushObjectResult.SUCCEEDED, result.explanation)
        harness.wait_until(is_back, what="a new learner")

    def test_killed_perception(self):
        self.start_task()
        self.wait_phase("push")
        is_back = self.kill("perception_node")
        result = self.finish_task()
        if result.status != PushObjectResult.SUCCEEDED:
            self.assertEqual(result.status, PushObjectResult.STOPPED, result.explanation)
            self.assertIn("is perception gone?", result.explanation)
        harness.wait_until(is_back, what="a new perception")

    def test_killed_executor(self):
        self.start_task()
        self.wait_phase("push")
        is_back = self.kill("executor_node")
        self.expect_still(is_told_to=False)
        harness.wait_until(is_back, what="a new executor")
        harness.wait_until(lambda: self.push_object.get_state() == GoalStatus.LOST,
                           what="the client to hear that the goal is lost")
        self.expect_next_task_succeeds()


if __name__ == "__main__":
    rospy.init_node("drill_nodes_test")
    rostest.rosrun("casepush", "drill_nodes", DrillNodesTest, sys.argv)
