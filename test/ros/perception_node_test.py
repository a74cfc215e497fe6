#!/usr/bin/env python3
"""Tracked poses agree with ground truth."""

import math
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose2D
from visualization_msgs.msg import MarkerArray

import harness
from casepush.msg import BodyPose, PushableObjectArray
from casepush.srv import SetPoses


def planar_error(message, x_m, y_m, yaw_rad):
    """Distance and turn between the tracked object and a pose."""
    if not message.objects:
        return math.inf, math.inf
    seen = message.objects[0].pose.pose
    turn = harness.yaw_of(seen.orientation) - yaw_rad
    return (math.hypot(seen.position.x - x_m, seen.position.y - y_m),
            abs(math.remainder(turn, 2 * math.pi)))


class PerceptionNodeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        rospy.wait_for_service("sim/set_pose", timeout=20)
        cls.set_pose = rospy.ServiceProxy("sim/set_pose", SetPoses)

    def put(self, x_m, y_m, yaw_rad):
        response = self.set_pose([BodyPose(harness.OBJECT, Pose2D(x_m, y_m, yaw_rad))])
        self.assertTrue(response.success, response.message)

    def test_sees_the_object_where_it_stands(self):
        self.put(0.0, 0.0, 0.0)

        def close(message):
            position_m, turn = planar_error(message, 0.0, 0.0, 0.0)
            at_rest = not message.objects[0].moving and message.objects[0].age < 0.5
            return position_m < 0.03 and turn < 0.05 and at_rest

        message = self.objects.wait(close)
        tracked = message.objects[0]
        self.assertEqual(message.header.frame_id, "map")
        self.assertEqual(tracked.id, harness.OBJECT)
        self.assertEqual(tracked.model, "office_chair")
        self.assertGreater(tracked.pose.covariance[0], 0.0)

    def test_notices_that_the_object_was_carried_away(self):
        self.put(0.5, 1.0, 1.0)
        self.objects.wait(lambda m: planar_error(m, 0.5, 1.0, 1.0)[0] < 0.05)

    def test_age_grows_while_the_object_is_out_of_sight(self):
        self.put(0.0, 0.0, 0.0)
        self.objects.wait(lambda m: planar_error(m, 0.0, 0.0, 0.0)[0] < 0.05)
        # Beyond the range of the cameras (6 m).
        response = self.set_pose([BodyPose("robot", Pose2D(4.2, 4.2, 0.0)),
                                  BodyPose(harness.OBJECT, Pose2D(-4.0, -4.0, 0.0))])
        self.assertTrue(response.success, response.message)
        self.objects.wait(lambda m: m.objects and m.objects[0].age > 2.0)
        response = self.set_pose([BodyPose("robot", Pose2D(-1.4, 0.0, 0.0)),
                                  BodyPose(harness.OBJECT, Pose2D(0.0, 0.0, 0.0))])
        self.assertTrue(response.success, response.message)

    def test_shows_object_and_robot(self):
        self.assertGreater(len(harness.Recorder("objects/markers", MarkerArray).wait(
            lambda m: len(m.markers) > 1).markers), 5)
        self.assertGreater(len(harness.Recorder("robot/markers", MarkerArray).wait().markers), 3)


if __name__ == "__main__":
    rospy.init_node("perception_node_test")
    rostest.rosrun("casepush", "perception_node", PerceptionNodeTest, sys.argv)
