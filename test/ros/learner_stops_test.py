#!/usr/bin/env python3
"""What a learner that has the robot drive does about pushes that are stopped or refused, an object
that is gone, and circumstances that changed."""

import os
import shutil
import sys
import tempfile
import threading
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus
from std_msgs.msg import Empty

import harness
from casepush.msg import (ExecutedPush, ExecutePushAction, ExecutePushResult, LearnObjectAction,
                          LearnObjectGoal, LearnObjectResult, Octomap, PushableObject,
                          PushableObjectArray, PushCaseArray)


class FakePerception:
    """Sees a chair at the origin, or nothing."""

    def __init__(self):
        self.sees = True
        self._publisher = rospy.Publisher("objects", PushableObjectArray, queue_size=1)
        self._timer = rospy.Timer(rospy.Duration(0.05), self._publish)

    def end(self):
        self._timer.shutdown()
        self._timer.join()

    def _publish(self, _):
        message = PushableObjectArray()
        message.header.frame_id = "map"
        message.header.stamp = rospy.Time.now()
        if self.sees:
            chair = PushableObject(id=harness.OBJECT, model="office_chair")
            chair.pose.pose = harness.pose(0.0, 0.0, 0.0).pose
            chair.last_seen = message.header.stamp
            message.objects.append(chair)
        self._publisher.publish(message)


class FakeExecutor:
    """Answers each goal with the next of `statuses`, and those after the last with EXECUTED."""

    def __init__(self):
        self._lock = threading.Lock()
        self.cases = harness.Recorder("cases", PushCaseArray)
        self.goals = []
        self.statuses = []
        self.after_goal = lambda: None
        self.waits_for_cancel = False
        self._server = actionlib.ActionServer("execute_push", ExecutePushAction, self._on_goal,
                                              self._on_cancel, auto_start=False)
        self._server.start()

    def _on_goal(self, handle):
        with self._lock:
            handle.set_accepted()
            goal = handle.get_goal()
            self.goals.append(goal)
            status = (self.statuses.pop(0) if self.statuses else ExecutePushResult.EXECUTED)
            result = ExecutePushResult(status=status, explanation=f"made-up status {status}")
            if status == ExecutePushResult.EXECUTED and not self._report(goal, result):
                result.status = ExecutePushResult.INVALID_GOAL
                result.explanation = f"there is no case {goal.case_id}"
            self.after_goal()
            if self.waits_for_cancel:
                return
            if result.status == ExecutePushResult.EXECUTED:
                handle.set_succeeded(result)
            else:
                handle.set_aborted(result)

    def _on_cancel(self, handle):
        with self._lock:
            if handle.get_goal_status().status in (GoalStatus.ACTIVE, GoalStatus.PREEMPTING):
                handle.set_canceled(ExecutePushResult(status=ExecutePushResult.CANCELLED))

    def _report(self, goal, result):
        """Fills in the report; false if there is no such case."""
        known = {case.id: case for case in self.cases.last().cases}
        if goal.case_id == 0:
            case = harness.made_up_case(0, 0.7 * len(known), 0.0)
        elif goal.case_id in known:
            case = harness.made_up_case(0, 0.0, 0.0)
            case.steps = known[goal.case_id].steps
            case.outcome.mean = known[goal.case_id].outcome.mean
        else:
            return False
        case.observation_count = case.effective_count = 1
        result.report = ExecutedPush(object_id=harness.OBJECT, case_id=goal.case_id,
                                     outcome=ExecutedPush.DONE, p_value=0.5, recorded=case,
                                     observed=case.outcome.mean, expected=case.outcome)
        result.report.end_stamp = rospy.Time.now()
        return True


class LearnerStopsTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.map = harness.Recorder("map/octomap", Octomap)
        cls.perception = FakePerception()
        cls.stops = rospy.Publisher("executor/stops", Empty, queue_size=1)
        cls.reports = rospy.Publisher("push_reports", ExecutedPush, queue_size=1)
        cls.executor = FakeExecutor()
        cls.map.wait()

    @classmethod
    def tearDownClass(cls):
        cls.perception.end()

    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.folder)
        self.perception.sees = True
        self.executor.cases.clear()
        self.executor.goals = []
        self.executor.statuses = []
        self.executor.after_goal = lambda: None
        self.executor.waits_for_cancel = False
        self.learner = harness.start_node("learner_node", "_world:=open_floor", "_reset:=drive",
                                          "_exploration/coverage:=random",
                                          f"_case_base:={os.path.join(self.folder, 'cases.db')}")
        self.addCleanup(harness.end_node, self.learner)
        self.client = actionlib.SimpleActionClient("learn_object", LearnObjectAction)
        harness.wait_until(self.client.action_client.wait_for_server, what="learn_object")
        self.executor.cases.wait()

    def await_listener(self, publisher):
        harness.wait_until(lambda: publisher.get_num_connections() > 0,
                           what="the learner to listen")

    def learn(self, cases=2, practices=2):
        self.client.send_goal(LearnObjectGoal(object_id=harness.OBJECT, cases=cases,
                                              practices=practices, seed=1))
        return harness.result_of(self.client, 40.0)

    def test_ends_when_a_push_is_stopped(self):
        self.executor.statuses = [ExecutePushResult.EXECUTED, ExecutePushResult.STOPPED]
        result = self.learn()
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertEqual(len(self.executor.goals), 2)
        self.assertEqual(result.pushes, 1)
        self.assertIn("finished pushes are kept", result.explanation)

    def test_ends_when_a_push_is_cancelled_by_somebody_else(self):
        self.executor.statuses = [ExecutePushResult.CANCELLED]
        result = self.learn()
        self.assertEqual(result.status, LearnObjectResult.CANCELLED, result.explanation)
        self.assertEqual(len(self.executor.goals), 1)

    def test_ends_when_the_robot_is_stopped_between_two_pushes(self):
        self.await_listener(self.stops)

        # Whatever it sends meanwhile is not finished, but cancelled.
        def stop():
            self.executor.waits_for_cancel = len(self.executor.goals) > 1
            self.stops.publish(Empty())
        self.executor.after_goal = stop
        result = self.learn(cases=14, practices=20)
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertIn("stopped by the service stop", result.explanation)
        self.assertLessEqual(len(self.executor.goals), 2)

    def test_learns_again_after_a_stop(self):
        self.executor.statuses = [ExecutePushResult.STOPPED]
        self.learn()
        result = self.learn()
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)

    def test_tries_again_when_refused_but_not_for_ever(self):
        self.executor.statuses = [ExecutePushResult.BUSY, ExecutePushResult.NOT_READY,
                                  ExecutePushResult.INVALID_GOAL]
        result = self.learn(cases=1, practices=2)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        self.assertEqual(self.executor.statuses, [])
        self.assertEqual({goal.case_id for goal in self.executor.goals[:4]}, {0})
        self.executor.statuses = [ExecutePushResult.BUSY] * 10
        result = self.learn(cases=1, practices=3)
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertEqual(len(self.executor.statuses), 5)

    def test_ends_when_the_object_is_gone(self):
        def hide():
            self.perception.sees = False
        self.executor.after_goal = hide
        result = self.learn(cases=14, practices=10000)
        self.assertEqual(result.status, LearnObjectResult.FAILED, result.explanation)
        self.assertIn("chair_1 is not in sight", result.explanation)
        self.assertGreater(result.pushes, 0)

    def test_learns_in_the_circumstances_that_were_noticed(self):
        self.assertEqual(self.learn().status, LearnObjectResult.DONE)
        first, second = self.executor.cases.wait(
            lambda m: [c.observation_count for c in m.cases] == [2, 2]).cases
        report = ExecutedPush(object_id=harness.OBJECT, case_id=first.id, sequence=1, adapted=True,
                              p_value=1e-6, recorded=first, expected=first.outcome)
        report.observed.x = 0.5 * first.outcome.mean.x
        report.observed.y = 0.5 * first.outcome.mean.y
        self.await_listener(self.reports)
        self.reports.publish(report)
        self.executor.cases.wait(lambda m: {c.noticed for c in m.cases} == {0, 1})
        result = self.learn(cases=2, practices=3)
        self.assertEqual(result.status, LearnObjectResult.DONE, result.explanation)
        self.assertIn("noticed change 1", result.explanation)
        known = self.executor.cases.wait(lambda m: [c.observation_count for c in m.cases
                                                    if c.noticed == 1] == [3, 3]).cases
        self.assertEqual([c.observation_count for c in known if c.id == second.id], [2])


if __name__ == "__main__":
    rospy.init_node("learner_stops_test")
    rostest.rosrun("casepush", "learner_stops", LearnerStopsTest, sys.argv)
