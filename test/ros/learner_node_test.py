#!/usr/bin/env python3
"""The learner keeps every finished push, and goes on where it was interrupted."""

import os
import shutil
import sys
import tempfile
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus

import harness
from casepush.msg import (ExecutedPush, LearnObjectAction, LearnObjectGoal, LearnObjectResult,
                          PushCaseArray)
from casepush.srv import ExportCases, ImportCases


class LearnerNodeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.file = os.path.join(cls.folder, "cases.db")
        cls.cases = harness.Recorder("cases", PushCaseArray)
        cls.reports = harness.Recorder("push_reports", ExecutedPush)
        cls.publish_report = rospy.Publisher("push_reports", ExecutedPush, queue_size=1)
        cls.learner = None
        cls.start_learner()

    @classmethod
    def tearDownClass(cls):
        harness.end_node(cls.learner)
        shutil.rmtree(cls.folder)

    @classmethod
    def start_learner(cls):
        cls.cases.clear()
        cls.learner = harness.start_node("learner_node", "_world:=open_floor",
                                         f"_case_base:={cls.file}")
        cls.client = actionlib.SimpleActionClient("learn_object", LearnObjectAction)
        harness.wait_until(cls.client.action_client.wait_for_server, what="learn_object")
        cls.cases.wait()

    def learn(self, cases, practices, patience_s=60.0):
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=cases,
                                              practices=practices, seed=1))
        return harness.result_of(self.client, patience_s)

    def counts(self):
        return [case.observation_count for case in self.cases.last().cases]

    def test_a_learns_and_publishes_each_push(self):
        feedback = []
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=1, practices=3,
                                              seed=1), feedback_cb=feedback.append)
        result = harness.result_of(self.client, 60.0)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        self.assertEqual(self.client.get_state(), GoalStatus.SUCCEEDED)
        self.cases.wait(lambda m: len(m.cases) == 1 and m.cases[0].observation_count == 3)
        self.assertEqual((feedback[-1].case_count, feedback[-1].practice_count), (1, 3))
        self.assertEqual(feedback[-1].practice_number, 3)

    def test_b_goes_on_after_being_killed(self):
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=2, practices=3,
                                              seed=2))
        self.cases.wait(lambda m: len(m.cases) == 2, 60.0)
        known = self.counts()
        harness.end_node(self.learner)
        self.start_learner()
        self.assertEqual(len(self.counts()), 2)
        self.assertGreaterEqual(sum(self.counts()), sum(known))
        result = self.learn(2, 3)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        self.cases.wait(lambda m: [c.observation_count for c in m.cases] == [3, 3])
        # Nothing is left to learn.
        result = self.learn(2, 3)
        self.assertEqual((result.status, result.pushes), (LearnObjectResult.DONE, 0))

    def test_c_cancelling_keeps_what_is_finished(self):
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=14, practices=20,
                                              seed=3))
        self.cases.wait(lambda m: len(m.cases) == 3, 60.0)
        self.client.cancel_goal()
        result = harness.result_of(self.client)
        self.assertEqual(self.client.get_state(), GoalStatus.PREEMPTED)
        self.assertEqual(result.status, LearnObjectResult.CANCELLED)
        self.assertGreaterEqual(result.cases, 3)

    def test_d_adapts_by_pushes_of_tasks_only(self):
        report = ExecutedPush(object_id=harness.OBJECT, sequence=1)
        known = self.cases.last().cases[0]
        report.case_id = known.id
        report.p_value = 0.5
        report.recorded = known
        report.recorded.outcome.mean.x += 0.05
        report.expected = known.outcome
        harness.wait_until(lambda: self.publish_report.get_num_connections() > 0, what="a listener")
        report.adapted = False
        self.publish_report.publish(report)
        report.adapted = True
        self.publish_report.publish(report)
        self.cases.wait(
            lambda m: m.cases[0].observation_count == known.observation_count + 1)

    def test_e_exports_and_imports(self):
        file = os.path.join(self.folder, "cases.yaml")
        count = len(self.cases.last().cases)
        exported = rospy.ServiceProxy("cases/export", ExportCases)(file)
        self.assertTrue(exported.success, exported.message)
        self.assertEqual(exported.count, count)
        imported = rospy.ServiceProxy("cases/import", ImportCases)(file)
        self.assertTrue(imported.success, imported.message)
        self.cases.wait(lambda m: len(m.cases) == 2 * count)
        failed = rospy.ServiceProxy("cases/import", ImportCases)("/nowhere/cases.yaml")
        self.assertFalse(failed.success)
        self.assertIn("/nowhere/cases.yaml", failed.message)

    def test_f_refuses_bad_goals(self):
        self.client.send_goal(LearnObjectGoal(object_id="piano_1"))
        result = harness.result_of(self.client)
        self.assertEqual(result.status, LearnObjectResult.INVALID_GOAL)
        self.assertIn("piano_1", result.explanation)


if __name__ == "__main__":
    rospy.init_node("learner_node_test")
    rostest.rosrun("casepush", "learner_node", LearnerNodeTest, sys.argv)
