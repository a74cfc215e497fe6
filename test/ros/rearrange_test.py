#!/usr/bin/env python3
"""push_object clears its way, and rearrange brings several objects to their goals in an order."""

import math
import os
import shutil
import sys
import tempfile
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D

import harness
from casepush.msg import (BodyPose, ExecutorState, ObjectGoal, Octomap, PushableObjectArray,
                          PushCaseArray, PushObjectAction, PushObjectGoal, PushObjectResult,
                          RearrangeAction, RearrangeGoal, RearrangeResult, TaskSummary)
from casepush.srv import ImportCases, SetPoses

STARTS = {"chair_1": (-2.4, 0.0), "chair_2": (0.0, 0.0)}


def wanted(object_id, x_m, y_m):
    return ObjectGoal(object_id=object_id, goal=harness.pose(x_m, y_m, 0.0),
                      position_tolerance=0.5, yaw_tolerance=math.pi)


class RearrangeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        world = os.path.join(harness.share(), "test/data/two_chairs.yaml")
        cls.learner = harness.start_node(
            "learner_node", f"_world:={world}",
            "_case_base:=" + os.path.join(cls.folder, "cases.db"))
        rospy.wait_for_service("cases/import", timeout=30)
        answer = rospy.ServiceProxy("cases/import", ImportCases)(
            os.path.join(harness.share(), "test/data/office_chair_cases.yaml"))
        assert answer.success, answer.message
        cls.cases = harness.Recorder("cases", PushCaseArray)
        cls.cases.wait(lambda message: message.cases)
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        cls.truth = harness.Recorder("ground_truth/objects", PushableObjectArray)
        cls.state = harness.Recorder("executor/state", ExecutorState)
        cls.push_object = actionlib.SimpleActionClient("push_object", PushObjectAction)
        cls.rearrange = actionlib.SimpleActionClient("rearrange", RearrangeAction)
        for client in (cls.push_object, cls.rearrange):
            harness.wait_until(client.action_client.wait_for_server, what="the executor's actions")
        harness.Recorder("map/octomap", Octomap).wait()
        rospy.wait_for_service("sim/set_pose", timeout=20)
        cls.set_pose = rospy.ServiceProxy("sim/set_pose", SetPoses)

    @classmethod
    def tearDownClass(cls):
        harness.end_node(cls.learner)
        shutil.rmtree(cls.folder)

    def setUp(self):
        poses = [BodyPose(name, Pose2D(x, y, 0.0)) for name, (x, y) in STARTS.items()]
        answer = self.set_pose(poses + [BodyPose("robot", Pose2D(-3.8, 1.4, -0.35))])
        self.assertTrue(answer.success, answer.message)
        self.objects.clear()
        self.objects.wait(lambda message: len(message.objects) == 2 and all(
            not each.moving and math.hypot(each.pose.pose.position.x - STARTS[each.id][0],
                                           each.pose.pose.position.y) < 0.05
            for each in message.objects))

    def ready(self, client, goal):
        """Sends a goal, again while the executor has not heard of everything yet."""
        def attempt():
            client.send_goal(goal)
            harness.wait_until(lambda: client.get_state() != GoalStatus.PENDING, what="an answer")
            refused = client.get_state() == GoalStatus.REJECTED
            return not refused or harness.result_of(client).status != RearrangeResult.NOT_READY

        harness.wait_until(attempt, what="the executor to get ready")

    def error_m(self, object_id, x_m, y_m):
        for each in self.truth.last().objects:
            if each.id == object_id:
                return math.hypot(each.pose.pose.position.x - x_m,
                                  each.pose.pose.position.y - y_m)
        self.fail(f"no {object_id}")
        return math.inf

    def test_pushes_what_stands_in_the_way_aside(self):
        goal = PushObjectGoal(object_id="chair_1", goal=harness.pose(2.4, 0.0, 0.0),
                              position_tolerance=0.5, yaw_tolerance=math.pi, seed=1,
                              clear_obstacles=True, planner="exp_rrt")
        self.ready(self.push_object, goal)
        result = harness.result_of(self.push_object, 100.0)
        self.assertEqual(result.status, PushObjectResult.SUCCEEDED, result.explanation)
        self.assertGreater(result.clearing_pushes, 0)
        self.assertGreater(result.pushes, 0)
        self.assertLess(self.error_m("chair_1", 2.4, 0.0), 0.55)
        self.assertGreater(self.error_m("chair_2", 0.0, 0.0), 0.1)

    def test_stops_at_once_while_it_looks_for_a_way_to_clear(self):
        goal = PushObjectGoal(object_id="chair_1", goal=harness.pose(2.4, 0.0, 0.0),
                              position_tolerance=0.5, yaw_tolerance=math.pi, seed=3,
                              clear_obstacles=True)
        self.ready(self.push_object, goal)
        self.state.wait(lambda state: state.activity == ExecutorState.PUSHING_OBJECT
                        and state.phase == "clear", 60.0)
        began_s = time.monotonic()
        self.push_object.cancel_goal()
        result = harness.result_of(self.push_object)
        self.assertLess(time.monotonic() - began_s, 0.5)
        self.assertEqual(result.status, PushObjectResult.CANCELLED, result.explanation)
        self.assertEqual(result.clearing_pushes, 0)

    def test_brings_two_objects_to_their_goals(self):
        goal = RearrangeGoal(goals=[wanted("chair_1", 1.6, 0.4), wanted("chair_2", 1.6, -1.8)],
                             seed=2)
        self.ready(self.rearrange, goal)
        feedback = harness.Recorder("executor/state", ExecutorState)
        summaries = harness.Recorder("task_summaries", TaskSummary)
        result = harness.result_of(self.rearrange, 130.0)
        self.assertEqual(result.status, RearrangeResult.SUCCEEDED, result.explanation)
        phases = set(state.phase for _, state in feedback.all()
                     if state.activity == ExecutorState.REARRANGING)
        self.assertIn("push", phases)
        self.assertEqual(result.order[0], "chair_2", "it stands in the way of chair_1")
        for entry in result.objects:
            self.assertTrue(entry.at_goal, entry)
            self.assertGreater(entry.turns, 0)
            self.assertGreater(entry.pushes, 0)
            self.assertLessEqual(entry.position_error, 0.5)
        self.assertLess(self.error_m("chair_1", 1.6, 0.4), 0.55)
        self.assertLess(self.error_m("chair_2", 1.6, -1.8), 0.55)
        told = [summary for _, summary in summaries.all()]
        for entry in result.objects:
            own = [summary for summary in told if summary.object_id == entry.object_id]
            self.assertEqual(len(own), entry.turns)
            self.assertEqual(sum(summary.pushes for summary in own), entry.pushes)
            self.assertEqual(own[-1].status, "succeeded", own[-1].explanation)
            self.assertGreater(own[-1].start_stamp.to_sec(), 0.0)
        self.assertEqual(len({summary.goal_id for summary in told}), 1)

    def test_refuses_what_cannot_be(self):
        fine = wanted("chair_1", 1.0, 0.4)
        nan = wanted("chair_1", math.nan, 0.4)
        for goal, words in (
                (RearrangeGoal(), "no goal"),
                (RearrangeGoal(goals=[fine, fine]), "two goals"),
                (RearrangeGoal(goals=[wanted("piano_1", 0, 0)]), "piano_1"),
                (RearrangeGoal(goals=[nan]), "finite"),
                (RearrangeGoal(goals=[fine], planner="oracle"), "oracle"),
                (RearrangeGoal(goals=[fine], risk="luck"), "sigma_points, chance"),
                (RearrangeGoal(goals=[fine], risk="chance", max_collision_probability=2.0),
                 "(0, 1]"),
                (RearrangeGoal(goals=[fine], time_limit=-1.0), "[0, 1e6]")):
            self.ready(self.rearrange, goal)
            result = harness.result_of(self.rearrange)
            self.assertEqual(result.status, RearrangeResult.INVALID_GOAL, result.explanation)
            self.assertEqual(self.rearrange.get_state(), GoalStatus.REJECTED)
            self.assertIn(words, result.explanation)
            self.assertNotIn("\n", result.explanation)
        push = PushObjectGoal(object_id="chair_1", goal=harness.pose(1.0, 0.0, 0.0),
                              planner="oracle")
        self.ready(self.push_object, push)
        self.assertIn("oracle", harness.result_of(self.push_object).explanation)

    def test_pushes_nothing_if_goals_contradict_each_other(self):
        self.ready(self.rearrange, RearrangeGoal(goals=[wanted("chair_1", 1.6, -1.8),
                                                        wanted("chair_2", 1.7, -1.8)]))
        result = harness.result_of(self.rearrange)
        self.assertEqual(result.status, RearrangeResult.INVALID_GOAL, result.explanation)
        self.assertIn("with all objects at their goals", result.explanation)
        self.assertIn("chair_2", result.explanation)
        self.assertEqual(sum(entry.pushes for entry in result.objects), 0)

    def test_is_the_only_task_and_can_be_cancelled(self):
        self.ready(self.rearrange, RearrangeGoal(goals=[wanted("chair_1", -2.0, 1.8)], seed=1))
        self.push_object.send_goal(PushObjectGoal(object_id="chair_1",
                                                  goal=harness.pose(1.0, 0.0, 0.0)))
        self.assertEqual(harness.result_of(self.push_object).status, PushObjectResult.BUSY)
        self.state.wait(lambda state: state.activity == ExecutorState.REARRANGING
                        and state.object_id == "chair_1")
        self.rearrange.cancel_goal()
        result = harness.result_of(self.rearrange)
        self.assertEqual(result.status, RearrangeResult.CANCELLED, result.explanation)
        self.assertEqual(result.objects[0].status, RearrangeResult.CANCELLED)
        self.assertEqual(self.rearrange.get_state(), GoalStatus.PREEMPTED)
        self.state.wait(lambda state: state.activity == ExecutorState.IDLE)


if __name__ == "__main__":
    rospy.init_node("rearrange_test")
    rostest.rosrun("casepush", "rearrange", RearrangeTest, sys.argv)
