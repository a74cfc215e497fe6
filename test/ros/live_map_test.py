#!/usr/bin/env python3
"""Without any prior map, the planner makes one from scans, furniture left out."""

import math
import os
import subprocess
import sys
import tempfile
import unittest

import actionlib
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist
from visualization_msgs.msg import MarkerArray

import harness
from casepush.msg import PlanPushAction, PlanPushGoal, PlanPushResult, PushableObjectArray
from casepush.srv import SaveMap


def voxels(markers):
    return [(p.x, p.y, p.z) for marker in markers.markers for p in marker.points]


def planner_values(message):
    for status in message.status:
        if status.name.startswith("planner_node"):
            return {value.key: value.value for value in status.values}
    return {}


class LiveMapTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.markers = harness.Recorder("map/markers", MarkerArray)
        cls.diagnostics = harness.Recorder("/diagnostics", DiagnosticArray)
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        cls.cases = harness.latched_cases()
        cls.client = actionlib.SimpleActionClient("plan_push", PlanPushAction)
        cls.command = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        harness.wait_until(cls.client.action_client.wait_for_server, what="plan_push")
        cls.turn_around()

    @classmethod
    def turn_around(cls):
        """Turns until there are walls on all four sides."""
        turn = Twist()
        turn.angular.z = 0.8

        def sees_all():
            cls.command.publish(turn)
            markers = cls.markers.last()
            found = voxels(markers) if markers else []
            return all(any(side(p) > 4.8 for p in found) for side in (
                lambda p: p[0], lambda p: p[1], lambda p: -p[0], lambda p: -p[1]))

        harness.wait_until(sees_all, patience_s=80.0, what="walls on all sides")
        cls.command.publish(Twist())

    def chair(self):
        return self.objects.wait(lambda m: len(m.objects) > 0).objects[0].pose.pose.position

    def test_the_chair_is_no_part_of_the_map(self):
        chair = self.chair()

        def near_chair():
            return [p for p in voxels(self.markers.last())
                    if math.hypot(p[0] - chair.x, p[1] - chair.y) < 0.4]

        # What was seen of it before it was tracked goes with the next change of the map.
        harness.wait_until(lambda: not near_chair(), what="the chair to leave the map")
        self.assertGreater(len(voxels(self.markers.last())), 300)

    def test_plans_on_it(self):
        goal = PlanPushGoal(object_id=harness.OBJECT, goal=harness.pose(2.0, 1.0, 0.8), seed=1)
        results = []

        def solved():
            self.client.send_goal(goal)
            results.append(harness.result_of(self.client))
            return results[-1].status == PlanPushResult.SOLVED

        harness.wait_until(solved, what="a plan")
        goal.goal = harness.pose(4.95, 0.0, 0.0)
        self.client.send_goal(goal)
        result = harness.result_of(self.client)
        self.assertIn(result.status, (PlanPushResult.GOAL_IN_COLLISION,
                                      PlanPushResult.GOAL_OUTSIDE_MAP), result.explanation)

    def test_saves_it(self):
        save = rospy.ServiceProxy("save_map", SaveMap)
        save.wait_for_service(10.0)
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "live.bt")
            response = save(file=file)
            self.assertTrue(response.success, response.message)
            info = subprocess.run([harness.node_path("casepush"), "map", "info", file, "--json"],
                                  capture_output=True, text=True, check=True)
            self.assertIn('"resolution_m":0.05', info.stdout)
            response = save(file=os.path.join(folder, "nowhere", "live.bt"))
            self.assertFalse(response.success)
            self.assertIn("cannot be written", response.message)

    def test_tells_what_it_costs(self):
        message = self.diagnostics.wait(
            lambda m: int(planner_values(m).get("scans in the map", 0)) > 3)
        self.assertLess(float(planner_values(message)["longest scan took [s]"]), 2.0)


if __name__ == "__main__":
    rospy.init_node("live_map_test")
    rostest.rosrun("casepush", "live_map_test", LiveMapTest, sys.argv)
