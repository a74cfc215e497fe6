#!/usr/bin/env python3
"""The planner takes floor plans and files for maps, and is back at work after a crash."""

import os
import sys
import tempfile
import unittest

import actionlib
import rospy
import rostest
from nav_msgs.msg import OccupancyGrid

import harness
from casepush.msg import ObjectPose, PlanPushAction, PlanPushGoal, PlanPushResult
from casepush.srv import SaveMap


def floor_plan():
    """10 m x 10 m around the origin, walls one cell thick, in cells of 10 cm."""
    grid = OccupancyGrid()
    grid.header.frame_id = "map"
    grid.info.resolution = 0.1
    grid.info.width = grid.info.height = 100
    grid.info.origin.position.x = grid.info.origin.position.y = -5.0
    grid.info.origin.orientation.w = 1.0
    grid.data = [100 if x in (0, 99) or y in (0, 99) else 0 for y in range(100) for x in range(100)]
    return grid


def goal(x_m):
    result = PlanPushGoal(object_id=harness.OBJECT, goal=harness.pose(x_m, 1.0, 0.8), seed=1,
                          state_given=True)
    result.objects = [ObjectPose(id=harness.OBJECT, model="office_chair")]
    result.robot.y = -3.0
    return result


class PlannerMapsTest(unittest.TestCase):

    def setUp(self):
        self.node = None
        self.client = None
        self.cases = harness.latched_cases()
        self.grid = rospy.Publisher("map", OccupancyGrid, queue_size=1, latch=True)

    def tearDown(self):
        if self.node is not None:
            harness.end_node(self.node)

    def forget_parameters(self, node):
        """Private parameters outlive the node that was started with them."""
        if rospy.has_param(node):
            rospy.delete_param(node)

    def start(self, *parameters):
        self.forget_parameters("/planner_node")
        self.node = harness.start_node("planner_node", "_world:=open_floor", *parameters)
        # A client of its own: an older one may still take the dead node for a server.
        self.client = actionlib.SimpleActionClient("plan_push", PlanPushAction)
        harness.wait_until(self.client.action_client.wait_for_server, what="plan_push")

    def answer(self, request):
        """Of the node that runs now: the first ones may precede map or cases."""
        results = []

        def attempt():
            self.client.send_goal(request)
            results.append(harness.result_of(self.client))
            early = results[-1].status == PlanPushResult.NO_CASES or (
                "no map yet" in results[-1].explanation)
            return not early

        harness.wait_until(attempt, what="map and cases")
        return results[-1]

    def check(self):
        self.assertEqual(self.answer(goal(2.5)).status, PlanPushResult.SOLVED)
        self.assertEqual(self.answer(goal(4.8)).status, PlanPushResult.GOAL_IN_COLLISION)
        self.assertEqual(self.answer(goal(5.4)).status, PlanPushResult.GOAL_OUTSIDE_MAP)

    def test_floor_plan_and_crash(self):
        self.grid.publish(floor_plan())
        self.start("_map_source:=map")
        self.check()
        harness.end_node(self.node)
        self.start("_map_source:=map")
        self.check()

    def test_says_that_walls_keep_the_object_from_the_goal(self):
        divided = floor_plan()
        divided.data = [100 if i % 100 == 70 else value for i, value in enumerate(divided.data)]
        self.grid.publish(divided)
        self.start("_map_source:=map")
        result = self.answer(goal(3.5))
        self.assertEqual(result.status, PlanPushResult.UNREACHABLE, result.explanation)
        self.assertIn("block every way", result.explanation)

    def test_says_why_there_is_no_map(self):
        bad = floor_plan()
        bad.info.resolution = 0.0
        self.grid.publish(bad)
        self.start("_map_source:=map")
        results = []

        def is_told():
            self.client.send_goal(goal(2.5))
            results.append(harness.result_of(self.client).explanation)
            return "refused: topic map: resolution is 0 m" in results[-1]

        harness.wait_until(is_told, what="the reason")
        self.assertIn("there is no map yet", results[-1])

    def test_saved_map_as_file(self):
        self.grid.publish(floor_plan())
        self.start("_map_source:=map", "_map_resolution:=0.1")
        self.check()
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "plan.bt")
            response = rospy.ServiceProxy("save_map", SaveMap)(file=file)
            self.assertTrue(response.success, response.message)
            harness.end_node(self.node)
            self.start(f"_map_file:={file}")
            self.check()

    def test_refuses_bad_maps_and_goes_on_with_the_last_good_one(self):
        self.grid.publish(floor_plan())
        self.start("_map_source:=map")
        self.check()
        bad = floor_plan()
        bad.data = bad.data[:-1]
        self.grid.publish(bad)
        elsewhere = floor_plan()
        elsewhere.header.frame_id = "atlantis"
        self.grid.publish(elsewhere)
        self.check()

    def test_bad_files_and_parameters_end_the_node_with_one_line(self):
        for parameters, words in (
                (["_map_file:=/no/such/map.bt"], "no such map file"),
                (["_map_source:=none"], "live_map"),
                (["_map_source:=moon"], "map_source"),
                (["_map_source:=map", "_map_file:=x.bt"], "map_source"),
                (["_occupancy/height:=-1.0"], "height"),
                (["_live/max_range:=0.0"], "max_range"),
                (["_map_resolution:=0.0"], "map_resolution"),
                (["_planner/kind:=crystal_ball"], "crystal_ball")):
            self.forget_parameters("/checked_planner_node")
            code, errors = harness.run_node("planner_node", "_world:=open_floor", *parameters)
            self.assertNotEqual(code, 0, parameters)
            self.assertIn(words, errors)


if __name__ == "__main__":
    rospy.init_node("planner_maps_test")
    rostest.rosrun("casepush", "planner_maps_test", PlannerMapsTest, sys.argv)
