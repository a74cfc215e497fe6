#!/usr/bin/env python3
"""The planner answers every goal: with a plan, or with what is wrong."""

import copy
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
        tilted = self.goal()
        tilted.goal.pose.orientation.x = tilted.goal.pose.orientation.w = math.sqrt(0.5)
        tilted.goal.pose.orientation.z = 0.0
        chair = ObjectPose(id=harness.OBJECT, model="office_chair")
        twice = self.goal(state_given=True, objects=[chair, chair])
        for goal, status, words in (
                (unknown, PlanPushResult.INVALID_REQUEST, "piano_1"),
                (nowhere, PlanPushResult.INVALID_REQUEST, "there is no TF from 'atlantis' to map"),
                (tilted, PlanPushResult.INVALID_REQUEST, "tilted by 90 deg"),
                (twice, PlanPushResult.INVALID_REQUEST, "'chair_1' is listed twice"),
                (no_quaternion, PlanPushResult.INVALID_REQUEST, "quaternion"),
                (not_finite, PlanPushResult.INVALID_REQUEST, "finite"),
                (tolerance, PlanPushResult.INVALID_REQUEST, "position_tolerance [m] is -1"),
                (self.goal(x_m=30.0), PlanPushResult.GOAL_OUTSIDE_MAP, ""),
                (self.goal(x_m=1e300), PlanPushResult.GOAL_OUTSIDE_MAP, "(1e+300, 1.5, 46 deg)"),
                (self.goal(x_m=4.9), PlanPushResult.GOAL_IN_COLLISION, "")):
            result = self.solved(goal)
            self.assertEqual(result.status, status, result.explanation)
            self.assertIn(words, result.explanation)
            self.assertNotEqual(result.explanation, "")
            self.assertEqual(self.client.get_state(), GoalStatus.ABORTED)

    def test_shortens_a_case_where_the_whole_one_leads_too_far(self):
        self.cases.publish(PushCaseArray(cases=[harness.made_up_case(1, 0.0, 0.0, length_m=1.2)]))
        goal = self.goal(x_m=0.6, y_m=0.0, yaw_rad=0.0, position_tolerance=0.3)
        results = []

        def found():
            results.append(self.plan(goal))
            return results[-1].status == PlanPushResult.SOLVED and len(
                results[-1].plan.pushes) == 1 and results[-1].plan.pushes[0].case_id < 0

        harness.wait_until(found, what="a plan with a shortened case")

    def test_says_that_there_are_no_cases(self):
        self.cases.publish(PushCaseArray())
        harness.wait_until(
            lambda: self.plan(self.goal()).status == PlanPushResult.NO_CASES, what="no cases")

    def test_says_that_cases_are_larger_than_the_room(self):
        few = PushCaseArray(cases=[harness.made_up_case(1, 0.0, 0.0, length_m=30.0)])
        self.cases.publish(few)
        harness.wait_until(lambda: self.plan(self.goal()).status == PlanPushResult.UNREACHABLE,
                           what="the large case")
        result = self.plan(self.goal())
        self.assertIn("no case can be applied", result.explanation)
        self.assertLess(result.planning_time, 1.0)

    def test_keeps_the_deadline_with_ten_thousand_cases(self):
        # Different enough that a tree grows, and shared, as a message of them all is large.
        kinds = [harness.made_up_case(1, 0.063 * k, 0.1 * (k % 9 - 4)) for k in range(100)]
        many = PushCaseArray(cases=[copy.copy(kinds[k % 100]) for k in range(10000)])
        for number, each in enumerate(many.cases):
            each.id = number + 1
        self.cases.publish(many)
        goal = self.goal(x_m=2.503, y_m=2.911, yaw_rad=3.0, yaw_tolerance=1e-3, deadline=1.0)
        results = []

        def attempt():
            results.append(self.plan(goal))
            return results[-1].status == PlanPushResult.DEADLINE

        harness.wait_until(attempt, 60.0, what="ten thousand cases to arrive")
        self.assertLess(results[-1].planning_time, goal.deadline + 0.5)

    def endless_goal(self):
        """A goal that no chain of cases hits: the search goes on until its deadline."""
        few = harness.made_up_cases()
        few.cases = [case for case in few.cases if case.outcome.mean.x > 0.45
                     or case.outcome.mean.x < -0.45]
        self.cases.publish(few)
        self.solved(self.goal(deadline=0.2))
        return self.goal(x_m=2.503, y_m=2.911, yaw_rad=0.1, position_tolerance=1e-4,
                         yaw_tolerance=1e-4, deadline=60.0)

    def cancelled_after_s(self, goal):
        ended = []
        fed_back = []
        self.client.send_goal(goal, done_cb=lambda *_: ended.append(time.monotonic()),
                              feedback_cb=fed_back.append)
        harness.wait_until(lambda: fed_back, what="feedback")
        began = time.monotonic()
        self.client.cancel_goal()
        harness.wait_until(lambda: ended, what="the end")
        result = self.client.get_result()
        self.assertEqual(result.status, PlanPushResult.CANCELLED, result.explanation)
        self.assertEqual(self.client.get_state(), GoalStatus.PREEMPTED)
        return ended[0] - began

    def test_cancels_at_once(self):
        goal = self.endless_goal()
        # The best of a few: other processes may hold this one up.
        times = [self.cancelled_after_s(goal) for _ in range(5)]
        rospy.loginfo("cancelled after %s s", times)
        self.assertLess(min(times), 0.05)
        self.assertLess(max(times), 1.0)

    def test_reports_progress_and_keeps_the_deadline(self):
        goal = self.endless_goal()
        goal.deadline = 1.0
        feedback = []
        self.client.send_goal(goal, feedback_cb=feedback.append)
        result = harness.result_of(self.client)
        self.assertIn(result.status, (PlanPushResult.DEADLINE, PlanPushResult.UNREACHABLE))
        self.assertLess(result.planning_time, goal.deadline + 0.5)
        self.assertGreater(feedback[-1].nodes, 0)
        self.assertGreaterEqual(feedback[-1].elapsed, feedback[0].elapsed)
        self.assertEqual(feedback[-1].best_cost, math.inf)

    def test_plans_with_any_planner(self):
        for planner in ("exp_rrt", "exp_rrt_paper", "lattice"):
            result = self.solved(self.goal(planner=planner))
            self.assertEqual(result.status, PlanPushResult.SOLVED,
                             planner + ": " + result.explanation)
        result = self.solved(self.goal(planner="crystal_ball"))
        self.assertEqual(result.status, PlanPushResult.INVALID_REQUEST)
        self.assertIn("crystal_ball", result.explanation)
        self.assertIn("exp_rrt", result.explanation)

    def test_bounds_the_risk_of_the_whole_plan(self):
        for planner in ("exp_rrt", "lattice"):
            result = self.solved(self.goal(planner=planner, risk="chance",
                                           max_collision_probability=0.1))
            self.assertEqual(result.status, PlanPushResult.SOLVED, result.explanation)
            plan = result.plan
            self.assertEqual(plan.risk, "chance")
            self.assertEqual(plan.max_collision_probability, 0.1)
            self.assertLessEqual(plan.collision_probability, 0.1)
            self.assertTrue(0.0 < plan.goal_probability <= 1.0, plan.goal_probability)
            self.assertTrue(all(push.collision_probability <= 0.1 for push in plan.pushes))
            spread = [push.compounded.covariance[0] for push in plan.pushes]
            self.assertGreater(spread[-1], spread[0])
        usual = self.solved(self.goal()).plan
        self.assertEqual((usual.risk, usual.zeta, usual.max_collision_probability),
                         ("sigma_points", 3.0, 0.0))

    def test_improves_until_the_deadline(self):
        goal = self.goal(x_m=4.0, y_m=4.0, yaw_rad=3.0, state_given=True, deadline=2.0)
        placed = ObjectPose(id=harness.OBJECT, model="office_chair")
        placed.pose.x = placed.pose.y = -3.5
        goal.objects = [placed]
        goal.robot.y = -3.0
        first = self.solved(goal)
        goal.anytime = True
        costs = []
        self.client.send_goal(goal,
                              feedback_cb=lambda feedback: costs.append(feedback.best_cost))
        result = harness.result_of(self.client)
        self.assertEqual(result.status, PlanPushResult.SOLVED, result.explanation)
        self.assertGreater(result.planning_time, 1.5)
        self.assertLess(result.planning_time, goal.deadline + 0.5)
        self.assertTrue(any(math.isfinite(cost) for cost in costs), costs)
        self.assertEqual(costs, sorted(costs, reverse=True))
        self.assertGreater(result.expected_time, 0.0)
        self.assertLessEqual(result.expected_time, costs[-1] + 1e-6)
        self.assertLessEqual(result.expected_time, first.expected_time)

    def test_names_the_bounds_of_risks(self):
        for fields, words in (
                ({"risk": "luck"}, "sigma_points, chance"),
                ({"risk": "chance", "max_collision_probability": 1.5}, "(0, 1]"),
                ({"risk": "chance", "max_collision_probability": math.nan}, "(0, 1]"),
                ({"max_collision_probability": 0.1}, "needs risk: chance"),
                ({"risk": "chance", "planner": "ompl_rrt"}, "use lattice or exp_rrt"),
                ({"deadline": -1.0}, "deadline"),
                ({"deadline": math.nan}, "deadline")):
            result = self.solved(self.goal(**fields))
            self.assertEqual(result.status, PlanPushResult.INVALID_REQUEST, result.explanation)
            self.assertIn(words, result.explanation)
            self.assertNotIn("\n", result.explanation)

    def test_says_that_the_object_stands_in_a_wall(self):
        goal = self.goal(state_given=True)
        placed = ObjectPose(id=harness.OBJECT, model="office_chair")
        placed.pose.x = 4.8
        goal.objects = [placed]
        result = self.solved(goal)
        self.assertEqual(result.status, PlanPushResult.START_IN_COLLISION, result.explanation)
        self.assertIn(harness.OBJECT, result.explanation)

    def test_says_that_no_case_can_be_applied(self):
        goal = self.goal(x_m=4.0, y_m=0.0, state_given=True, deadline=20.0)
        goal.objects = [ObjectPose(id=harness.OBJECT, model="office_chair")]
        for k in range(4):
            guard = ObjectPose(id=f"guard_{k}", model="office_chair")
            guard.pose.x = 0.85 * math.cos(k * math.pi / 2)
            guard.pose.y = 0.85 * math.sin(k * math.pi / 2)
            goal.objects.append(guard)
        goal.robot.y = -3.0
        result = self.solved(goal)
        self.assertEqual(result.status, PlanPushResult.UNREACHABLE, result.explanation)
        self.assertIn("clear some space", result.explanation)


if __name__ == "__main__":
    rospy.init_node("planner_node_test")
    rostest.rosrun("casepush", "planner_node", PlannerNodeTest, sys.argv)
