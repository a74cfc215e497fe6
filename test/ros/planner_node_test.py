#!/usr/bin/env python3
"""The planner answers every goal: with a plan, or with what is wrong."""

import math
import sys
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from visualization_msgs.msg import MarkerArray

import harness
from casepush.msg import (ObjectPose, Octomap, Plan, PlanPushAction, PlanPushGoal, PlanPushResult,
                          PushableObjectArray, PushCaseArray)


class PlannerNodeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        cls.cases = rospy.Publisher("cases", PushCaseArray, queue_size=1, latch=True)
        cls.client = actionlib.SimpleActionClient("plan_push", PlanPushAction)
        harness.wait_until(cls.client.action_client.wait_for_server, what="plan_push")
        harness.Recorder("map/octomap", Octomap).wait()
        cls.objects.wait(lambda m: len(m.objects) > 0)

    def setUp(self):
        self.cases.publish(harness.made_up_cases())

    def plan(self, goal, patience_s=30.0):
        self.client.send_goal(goal)
        return harness.result_of(self.client, patience_s)

    def goal(self, x_m=2.5, y_m=1.5, yaw_rad=0.8, **fields):
        return PlanPushGoal(object_id=harness.OBJECT, goal=harness.pose(x_m, y_m, yaw_rad), seed=1,
                            **fields)

    def solved(self, goal):
        """The first answer may precede the cases, which travel over another connection."""
        results = []

        def attempt():
            results.append(self.plan(goal))
            return results[-1].status != PlanPushResult.NO_CASES

        harness.wait_until(attempt, what="cases to arrive")
        return results[-1]

    def test_plans_from_where_everything_is_now(self):
        plans = harness.Recorder("plan", Plan)
        markers = harness.Recorder("plan/markers", MarkerArray)
        result = self.solved(self.goal())
        self.assertEqual(result.status, PlanPushResult.SOLVED, result.explanation)
        self.assertEqual(self.client.get_state(), GoalStatus.SUCCEEDED)
        start = result.plan.pushes[0].start
        self.assertLess(math.hypot(start.x, start.y), 0.05)
        end = result.plan.pushes[-1].outcome.mean
        self.assertLess(math.hypot(end.x - 2.5, end.y - 1.5), 0.2)
        self.assertLess(abs(math.remainder(end.theta - 0.8, 2 * math.pi)), math.pi / 9)
        self.assertEqual(len(plans.wait().pushes), len(result.plan.pushes))
        self.assertGreater(len(markers.wait().markers), 5)

    def test_plans_from_a_given_state(self):
        goal = self.goal(state_given=True)
        placed = ObjectPose(id=harness.OBJECT, model="office_chair")
        placed.pose.x = -2.0
        goal.objects = [placed]
        goal.robot.x = 0.0
        goal.robot.y = -3.0
        result = self.solved(goal)
        self.assertEqual(result.status, PlanPushResult.SOLVED, result.explanation)
        self.assertAlmostEqual(result.plan.pushes[0].start.x, -2.0, delta=1e-6)

    def test_takes_goals_in_other_frames(self):
        goal = self.goal()
        goal.goal = harness.pose(3.0, 0.0, 0.0, frame="base_link")
        result = self.solved(goal)
        self.assertEqual(result.status, PlanPushResult.SOLVED, result.explanation)
        # The robot stands at (-1.4, 0) and looks along x.
        self.assertAlmostEqual(result.plan.goal.x, 1.6, delta=0.05)

    def test_says_what_is_wrong(self):
        unknown = self.goal()
        unknown.object_id = "piano_1"
        nowhere = self.goal()
        nowhere.goal.header.frame_id = "atlantis"
        no_quaternion = self.goal()
        no_quaternion.goal.pose.orientation.z = no_quaternion.goal.pose.orientation.w = 0.0
        not_finite = self.goal()
        not_finite.goal.pose.position.x = math.nan
        tolerance = self.goal(position_tolerance=-1.0)
        for goal, status, words in (
                (unknown, PlanPushResult.INVALID_REQUEST, "piano_1"),
                (nowhere, PlanPushResult.INVALID_REQUEST, "atlantis"),
                (no_quaternion, PlanPushResult.INVALID_REQUEST, "quaternion"),
                (not_finite, PlanPushResult.INVALID_REQUEST, "finite"),
                (tolerance, PlanPushResult.INVALID_REQUEST, "tolerance"),
                (self.goal(x_m=30.0), PlanPushResult.GOAL_OUTSIDE_MAP, ""),
                (self.goal(x_m=4.9), PlanPushResult.GOAL_IN_COLLISION, "")):
            result = self.solved(goal)
            self.assertEqual(result.status, status, result.explanation)
            self.assertIn(words, result.explanation)
            self.assertNotEqual(result.explanation, "")
            self.assertEqual(self.client.get_state(), GoalStatus.ABORTED)

    def test_says_that_there_are_no_cases(self):
        self.cases.publish(PushCaseArray())
        harness.wait_until(
            lambda: self.plan(self.goal()).status == PlanPushResult.NO_CASES, what="no cases")

    def test_cancels_at_once(self):
        # One case that leads nowhere near the goal: the tree grows until the deadline.
        few = harness.made_up_cases()
        few.cases = [case for case in few.cases if case.outcome.mean.x > 0.45
                     or case.outcome.mean.x < -0.45]
        self.cases.publish(few)
        self.solved(self.goal(deadline=0.2))
        goal = self.goal(x_m=2.503, y_m=2.911, yaw_rad=0.1, position_tolerance=1e-4,
                         yaw_tolerance=1e-4, deadline=60.0)
        self.client.send_goal(goal)
        harness.wait_until(lambda: self.client.get_state() == GoalStatus.ACTIVE, what="planning")
        cancelled = time.monotonic()
        self.client.cancel_goal()
        harness.wait_until(lambda: self.client.get_state() > GoalStatus.ACTIVE, what="the end")
        self.assertLess(time.monotonic() - cancelled, 0.5)
        self.assertIn(self.client.get_state(), (GoalStatus.PREEMPTED, GoalStatus.ABORTED))


if __name__ == "__main__":
    rospy.init_node("planner_node_test")
    rostest.rosrun("casepush", "planner_node", PlannerNodeTest, sys.argv)
