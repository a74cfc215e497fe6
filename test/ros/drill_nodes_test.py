#!/usr/bin/env python3
"""Nodes are killed or hang in the middle of a task; roslaunch starts dead ones again."""

import contextlib
import os
import sqlite3
import sys

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

import drill
import harness
from casepush.msg import PushObjectResult


class DrillNodesTest(drill.Drill):

    def test_only_the_executor_commands_the_base(self):
        publishers = dict(rospy.get_master().getSystemState()[2][0])
        self.assertEqual(publishers["/cmd_vel"], ["/executor_node"])

    def test_killed_planner(self):
        self.start_task()
        self.wait_phase("approach", "dock", "push")
        is_back = drill.kill("planner_node")
        self.finish_task(PushObjectResult.PLANNER_GONE)
        harness.wait_until(is_back, what="a new planner")
        self.expect_next_task_succeeds()

    def test_planner_hangs(self):
        self.start_task()
        self.wait_phase("push")
        with drill.suspended("planner_node"):
            self.place(chair_1=(-0.3, -1.0, 1.0))  # What it has planned is of no use any more.
            self.finish_task(PushObjectResult.PLANNER_GONE)
        self.expect_next_task_succeeds()

    def test_killed_learner(self):
        self.start_task()
        self.wait_phase("push")
        is_back = drill.kill("learner_node")
        self.finish_task()
        harness.wait_until(is_back, what="a new learner")

    def test_killed_perception(self):
        self.start_task()
        self.wait_phase("push")
        is_back = drill.kill("perception_node")
        self.finish_task(PushObjectResult.SUCCEEDED, PushObjectResult.STOPPED,
                         explanation="is perception gone?")
        harness.wait_until(is_back, what="a new perception")
        self.expect_next_task_succeeds()

    def test_killed_executor(self):
        self.start_task()
        self.wait_phase("push")
        is_back = drill.kill("executor_node")
        self.expect_still(is_told_to=False)
        harness.wait_until(is_back, what="a new executor")
        harness.wait_until(lambda: self.push_object.get_state() == GoalStatus.LOST,
                           what="the client to hear that the goal is lost")
        self.expect_next_task_succeeds()

    def test_killed_simulator(self):
        self.start_task()
        self.wait_phase("push")
        self.motion.clear()
        is_back = drill.kill("sim_node")
        harness.wait_until(is_back, what="a new simulator")
        self.motion.clear()
        self.motion.wait()
        self.finish_task(PushObjectResult.STOPPED, explanation="time")
        self.await_nodes()
        self.setUp()
        self.expect_next_task_succeeds()

    def kill_learner_if_there(self):
        """It ends by itself when it finds its case base damaged."""
        with contextlib.suppress(OSError):
            drill.kill("learner_node")

    def test_the_case_base_is_cut_short(self):
        copy = self.case_base + ".copy"
        with contextlib.closing(sqlite3.connect(self.case_base)) as database:
            database.execute("PRAGMA wal_checkpoint(TRUNCATE)")  # Or all might be in the log still.
            database.execute("VACUUM INTO ?", (copy,))
        self.start_task()
        self.wait_phase("push")
        os.truncate(self.case_base, os.path.getsize(self.case_base) // 2)
        try:
            self.end_task()
            self.kill_learner_if_there()
            code, text = harness.run_node("learner_node", "_world:=open_floor",
                                          f"_case_base:={self.case_base}")
            self.assertEqual(code, 2, text)
            self.assertIn("damaged or truncated", text)
        finally:
            self.kill_learner_if_there()
            for suffix in ("-wal", "-shm"):
                if os.path.exists(self.case_base + suffix):
                    os.remove(self.case_base + suffix)
            os.replace(copy, self.case_base)
        self.cases.clear()
        self.cases.wait(lambda m: m.cases)
        self.expect_next_task_succeeds()


if __name__ == "__main__":
    rospy.init_node("drill_nodes_test")
    rostest.rosrun("casepush", "drill_nodes", DrillNodesTest, sys.argv)
