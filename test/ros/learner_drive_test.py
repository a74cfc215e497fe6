#!/usr/bin/env python3
"""A robot that nobody helps: it drives around the chair, keeps it off the walls, and goes on after
its learner was killed."""

import math
import os
import shutil
import sys
import tempfile
import unittest

import actionlib
import rospy
import rostest
from geometry_msgs.msg import Twist
from std_srvs.srv import Trigger

import harness
from casepush.msg import (BodyContactArray, LearnObjectAction, LearnObjectGoal, LearnObjectResult,
                          PushCaseArray, PushableObjectArray)


class LearnerDriveTest(unittest.TestCase):

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.cases = harness.Recorder("cases", PushCaseArray)
        self.truth = harness.Recorder("ground_truth/objects", PushableObjectArray, keep=1000000)
        self.contacts = harness.Recorder("contacts", BodyContactArray, keep=1000000)
        self.learner = None
        self.start_learner()

    def tearDown(self):
        harness.end_node(self.learner)
        shutil.rmtree(self.folder)

    def start_learner(self):
        self.cases.clear()
        self.learner = harness.start_node("learner_node", "_world:=open_floor", "_reset:=drive",
                                          f"_case_base:={os.path.join(self.folder, 'cases.db')}")
        self.client = actionlib.SimpleActionClient("learn_object", LearnObjectAction)
        harness.wait_until(self.client.action_client.wait_for_server, what="learn_object")
        self.cases.wait()

    def test_learns_without_any_help_and_resumes_after_kill(self):
        goal = LearnObjectGoal(object_id=harness.OBJECT, cases=3, practices=4, seed=1)
        self.client.send_goal(goal)
        self.cases.wait(lambda m: sum(c.observation_count for c in m.cases) >= 5, 90.0)
        known = sum(c.observation_count for c in self.cases.last().cases)
        self.learner.kill()
        self.learner.wait()
        self.start_learner()
        self.assertGreaterEqual(sum(c.observation_count for c in self.cases.last().cases), known)
        feedback = []
        self.client.send_goal(goal, feedback_cb=feedback.append)
        result = harness.result_of(self.client, 90.0)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        counts = [c.observation_count for c in self.cases.last().cases]
        self.assertEqual(len(counts), 3)
        self.assertGreaterEqual(min(counts), 4)
        self.assertLess(result.pushes, 40)
        self.assertLessEqual({f.phase for f in feedback}, {"explore", "practise", "bring back"})
        # The chair stood still but for pushes (nobody put it anywhere), away from the walls.
        poses = [m.objects[0].pose.pose.position for _, m in self.truth.all()]
        steps = [abs(b.x - a.x) + abs(b.y - a.y) for a, b in zip(poses, poses[1:])]
        self.assertLess(max(steps), 0.2)
        self.assertLess(max(max(abs(p.x), abs(p.y)) for p in poses), 4.3)
        walls = [c for _, m in self.contacts.all() for c in m.contacts
                 if "wall" in c.body_a or "wall" in c.body_b]
        self.assertEqual(walls, [])

    def test_stops_for_good_by_the_service(self):
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=14, practices=20,
                                              seed=2))
        commands = harness.Recorder("cmd_vel", Twist)
        commands.wait(lambda m: math.hypot(m.linear.x, m.linear.y) > 0.1, 60.0)
        stop = rospy.ServiceProxy("stop", Trigger)
        self.assertTrue(stop().success)
        result = harness.result_of(self.client)
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertIn("stopped by the service stop", result.explanation)
        # It tells the base once more to stand, so what comes after that comes too late.
        commands.clear()
        self.assertTrue(stop().success)
        commands.wait(harness.is_zero)
        commands.clear()
        stamp = self.truth.last().header.stamp
        self.truth.wait(lambda m: m.header.stamp > stamp + rospy.Duration(10.0))
        self.assertEqual([m for _, m in commands.all() if not harness.is_zero(m)], [])


if __name__ == "__main__":
    rospy.init_node("learner_drive_test")
    rostest.rosrun("casepush", "learner_drive", LearnerDriveTest, sys.argv)
