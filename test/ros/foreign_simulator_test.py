#!/usr/bin/env python3
"""With a simulator that only does what docs/ros_api.md asks of one, tasks succeed, and what needs
more says so."""

import os
import sys

import actionlib
import rospy
import rostest

import harness
from casepush.msg import (LearnObjectAction, LearnObjectGoal, LearnObjectResult, PushObjectGoal,
                          PushObjectResult)
from casepush.srv import ImportCases
from pushing import PushingTest


class ForeignSimulatorTest(PushingTest):

    @classmethod
    def tearDownClass(cls):
        case_base = rospy.get_param("learner_node/case_base")
        for suffix in ("", "-wal", "-shm"):
            if os.path.exists(case_base + suffix):
                os.remove(case_base + suffix)

    def test_pushes_an_object_to_its_goal(self):
        importer = rospy.ServiceProxy("cases/import", ImportCases)
        importer.wait_for_service(30.0)
        answer = importer(os.path.join(harness.share(), "test/data/office_chair_cases.yaml"))
        self.assertTrue(answer.success, answer.message)
        self.start(self.push_object, PushObjectGoal(
            object_id=harness.OBJECT, goal=harness.pose(1.2, 0.8, 0.5), seed=1, time_limit=240.0))
        result = harness.result_of(self.push_object, 90.0)
        self.assertEqual(result.status, PushObjectResult.SUCCEEDED, result.explanation)

    def test_says_what_teleporting_lacks(self):
        learn = actionlib.SimpleActionClient("learn_object", LearnObjectAction)
        harness.wait_until(learn.action_client.wait_for_server, what="learn_object")
        learn.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=15, practices=20))
        result = harness.result_of(learn, 40.0)
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertIn("no service sim/set_pose", result.explanation)


if __name__ == "__main__":
    rospy.init_node("foreign_simulator_test")
    rostest.rosrun("casepush", "foreign_simulator", ForeignSimulatorTest, sys.argv)
