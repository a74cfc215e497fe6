#!/usr/bin/env python3
"""The executor stands still whenever something it needs is gone, and says why."""

import copy
import math
import signal
import sys
import time

import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry

import harness
from casepush.msg import (ExecutedPush, ExecutePushGoal, ExecutePushResult, ExecutorState,
                          PushCaseArray, PushObjectGoal, PushObjectResult, TrialPush)
from pushing import PushingTest

WORLD = "_world:=open_floor"
# Within this wall time after an event (at real-time factor 1) no command moves the base any more.
REACTION_S = 0.2
# Age at which poses count as stale.
STALE_S = 0.2
# For the scheduling of a busy machine.
SLACK_S = 0.1


class ExecutorNodeTest(PushingTest):

    @classmethod
    def setUpClass(cls):
        cls.sim = harness.start_node("sim_node", WORLD, "_real_time_factor:=1.0")
        cls.perception = harness.start_node("perception_node", WORLD)
        cls.planner = harness.start_node("planner_node", WORLD)
        super().setUpClass()
        cls.odometry = harness.Recorder("odom", Odometry)
        cls.fake_odometry = rospy.Publisher("odom", Odometry, queue_size=1)
        cls.by_hand = rospy.Publisher("teleop_cmd_vel", Twist, queue_size=1)
        cls.fake_cases = rospy.Publisher("cases", PushCaseArray, queue_size=1, latch=True)
        cls.await_nodes()
        harness.wait_until(cls.executor_knows_map_and_robot, what="the executor to get ready")

    @classmethod
    def executor_knows_map_and_robot(cls):
        """Without cases it refuses any goal, but for that reason only once it knows the rest."""
        cls.push_object.send_goal(PushObjectGoal(object_id=harness.OBJECT,
                                                 goal=harness.pose(2.5, 1.5, 0.5)))
        return "there are no cases" in harness.result_of(cls.push_object).explanation

    @classmethod
    def tearDownClass(cls):
        for process in (cls.sim, cls.perception, cls.planner):
            harness.end_node(process)

    def setUp(self):
        self.fake_cases.publish(harness.made_up_cases())
        self.set_scene()

    def tearDown(self):
        self.stop()

    def result(self, client, goal, patience_s=30.0):
        client.send_goal(goal)
        return harness.result_of(client, patience_s)

    def replay(self, case_id=2):
        return ExecutePushGoal(object_id=harness.OBJECT, case_id=case_id)

    def push_goal(self):
        return PushObjectGoal(object_id=harness.OBJECT, goal=harness.pose(2.5, 1.5, 0.5), seed=1)

    def start_moving(self, client, goal):
        self.start(client, goal)
        self.wait_moving()

    def expect_standstill(self, event, within_s):
        """No command later than `within_s` after the event moves the base, and one says zero."""
        harness.wait_until(lambda: time.monotonic() > event + within_s + 0.5, what="time to pass")
        late = [(stamp - event, command) for stamp, command in self.commands.all()
                if stamp > event + within_s and not harness.is_zero(command)]
        self.assertEqual(late, [])
        zeros = [stamp for stamp, command in self.commands.all()
                 if stamp > event and harness.is_zero(command)]
        self.assertTrue(zeros, "nobody told the base to stand still")

    def test_executes_a_push_and_reports_it(self):
        trial = ExecutePushGoal(object_id=harness.OBJECT)
        trial.configuration = TrialPush(
            object_T_robot=Pose2D(-harness.REACH_M, 0.0, 0.0), speed=0.3, duration=2.0)
        result = self.result(self.execute_push, trial, 60.0)
        self.assertEqual(result.status, ExecutePushResult.EXECUTED, result.explanation)
        self.assertEqual(result.report.outcome, ExecutedPush.DONE, result.report.explanation)
        self.assertGreater(result.report.observed.x, 0.1)
        report = self.reports.wait()
        self.assertEqual(report.sequence, 1)
        self.assertGreater(len(report.recorded.steps), 10)
        self.assertFalse(report.adapted)
        self.assertEqual(self.state.wait().activity, ExecutorState.IDLE)

    def test_stops_when_cancelled(self):
        self.start_moving(self.execute_push, self.replay())
        event = time.monotonic()
        self.execute_push.cancel_goal()
        self.expect_standstill(event, REACTION_S)
        self.assertEqual(self.execute_push.get_state(), GoalStatus.PREEMPTED)
        self.assertEqual(self.execute_push.get_result().status, ExecutePushResult.CANCELLED)

    def test_stops_by_the_service(self):
        self.start_moving(self.push_object, self.push_goal())
        event = time.monotonic()
        self.assertTrue(self.stop().success)
        self.expect_standstill(event, REACTION_S)
        self.assertEqual(harness.result_of(self.push_object).status, PushObjectResult.STOPPED)

    def test_stops_when_perception_dies(self):
        self.start_moving(self.execute_push, self.replay())
        event = time.monotonic()
        self.perception.kill()
        self.expect_standstill(event, STALE_S + REACTION_S)
        result = harness.result_of(self.execute_push)
        self.assertEqual(result.status, ExecutePushResult.STOPPED, result.explanation)
        self.assertIn("perception", result.explanation)
        self.perception.wait()
        type(self).perception = harness.start_node("perception_node", WORLD)

    def test_stops_when_the_planner_dies(self):
        self.start_moving(self.push_object, self.push_goal())
        event = time.monotonic()
        self.planner.kill()
        self.expect_standstill(event, REACTION_S)
        result = harness.result_of(self.push_object)
        self.assertEqual(result.status, PushObjectResult.PLANNER_GONE, result.explanation)
        self.planner.wait()
        type(self).planner = harness.start_node("planner_node", WORLD)

    def test_stops_when_the_simulator_dies(self):
        self.start_moving(self.execute_push, self.replay())
        event = time.monotonic()
        self.sim.send_signal(signal.SIGSTOP)
        try:
            self.expect_standstill(event, REACTION_S + SLACK_S)
            result = harness.result_of(self.execute_push)
            self.assertEqual(result.status, ExecutePushResult.STOPPED)
            self.assertIn("time has stood still", result.explanation)
        finally:
            self.sim.send_signal(signal.SIGCONT)

    def test_stops_when_tf_freezes(self):
        self.start_moving(self.execute_push, self.replay())
        self.sim.send_signal(signal.SIGSTOP)
        try:
            event = time.monotonic()
            message = self.odometry.last()
            # Odometry goes on at the same pace, TF does not.
            while time.monotonic() < event + 1.0:
                step = int((time.monotonic() - event) / 0.02) + 1
                harness.wait_until(lambda s=step: time.monotonic() > event + 0.02 * s)
                message.header.stamp += rospy.Duration(0.02)
                self.fake_odometry.publish(message)
            self.expect_standstill(event, STALE_S + REACTION_S)
        finally:
            self.sim.send_signal(signal.SIGCONT)

    def test_stops_when_nothing_is_known_of_the_robot(self):
        self.start_moving(self.push_object, self.push_goal())
        self.sim.send_signal(signal.SIGSTOP)
        try:
            message = copy.deepcopy(self.odometry.last())
            message.twist.twist.linear.x = math.nan

            def is_over():
                message.header.stamp += rospy.Duration(0.02)
                self.fake_odometry.publish(message)
                return self.push_object.get_result() is not None

            harness.wait_until(is_over, what="the task to end")
            result = self.push_object.get_result()
            self.assertEqual(result.status, PushObjectResult.STOPPED, result.explanation)
            self.assertIn("neither pose nor speed", result.explanation)
            self.assertTrue(harness.is_zero(self.commands.last()))
        finally:
            self.sim.send_signal(signal.SIGCONT)

    def test_stands_still_if_somebody_drives_it_by_numbers_that_are_none(self):
        command = Twist()
        command.linear.x = math.nan

        def is_told_to_stand():
            self.by_hand.publish(command)
            return self.commands.last() is not None and harness.is_zero(self.commands.last())

        self.commands.clear()
        harness.wait_until(is_told_to_stand, what="a command")
        # Nobody drives any more after a while, and the executor is still there to answer.
        harness.wait_until(lambda: self.result(self.execute_push, ExecutePushGoal()).status ==
                           ExecutePushResult.INVALID_GOAL, what="the executor to be free again")

    def test_refuses_a_second_goal(self):
        self.start_moving(self.execute_push, self.replay())
        result = self.result(self.push_object, self.push_goal())
        self.assertEqual(self.push_object.get_state(), GoalStatus.REJECTED)
        self.assertEqual(result.status, PushObjectResult.BUSY)
        self.assertIn("busy", result.explanation)
        self.execute_push.cancel_goal()
        harness.result_of(self.execute_push)

    def test_refuses_bad_goals_with_a_reason(self):
        unknown = self.push_goal()
        unknown.object_id = "piano_1"
        nowhere = self.push_goal()
        nowhere.goal.header.frame_id = "atlantis"
        not_finite = self.push_goal()
        not_finite.goal.pose.position.x = math.nan
        tolerance = self.push_goal()
        tolerance.yaw_tolerance = 7.0
        for goal, words in ((unknown, "piano_1"), (not_finite, "finite"),
                            (nowhere, "there is no TF from 'atlantis' to map"),
                            (tolerance, "yaw_tolerance [rad] is 7")):
            result = self.result(self.push_object, goal)
            self.assertEqual(result.status, PushObjectResult.INVALID_GOAL, result.explanation)
            self.assertIn(words, result.explanation)
        trial = ExecutePushGoal(object_id=harness.OBJECT)
        trial.configuration = TrialPush(speed=99.0, duration=1.0)
        for goal, words in ((self.replay(4711), "4711"), (trial, "speed")):
            result = self.result(self.execute_push, goal)
            self.assertEqual(result.status, ExecutePushResult.INVALID_GOAL, result.explanation)
            self.assertIn(words, result.explanation)
        outside = self.push_goal()
        outside.goal.pose.position.x = 40.0
        result = self.result(self.push_object, outside)
        self.assertEqual(result.status, PushObjectResult.INVALID_GOAL, result.explanation)

    def test_tells_of_somebody_else_who_commands_the_base(self):
        diagnostics = harness.Recorder("/diagnostics", DiagnosticArray)
        other = rospy.Publisher("cmd_vel", Twist, queue_size=1)

        def is_told():
            other.publish(Twist())
            return any("commands the base, too" in status.message
                       for _, message in diagnostics.all() for status in message.status)

        harness.wait_until(is_told, what="the executor to notice")
        other.unregister()

    def test_refuses_the_case_of_another_object(self):
        cases = harness.made_up_cases()
        cases.cases[1].object = "utility_cart"
        self.fake_cases.publish(cases)
        results = []

        def is_refused():
            results.append(self.result(self.execute_push, self.replay(cases.cases[1].id)))
            return results[-1].status == ExecutePushResult.INVALID_GOAL

        harness.wait_until(is_refused, what="the case of a cart")
        self.assertIn("is of utility_cart", results[-1].explanation)

    def test_refuses_to_push_without_cases(self):
        self.fake_cases.publish(PushCaseArray())
        harness.wait_until(lambda: self.result(self.push_object, self.push_goal()).status ==
                           PushObjectResult.NOT_READY, what="the cases to be gone")
        self.assertIn("no cases", self.push_object.get_result().explanation)


if __name__ == "__main__":
    rospy.init_node("executor_node_test")
    rostest.rosrun("casepush", "executor_node", ExecutorNodeTest, sys.argv)
