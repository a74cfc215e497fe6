#!/usr/bin/env python3
"""The simulator keeps to the interface of a robot."""

import math
import sys
import time
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import Point, Pose2D, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock, Log
from sensor_msgs.msg import PointCloud2

import harness
from casepush.msg import AprilTagDetectionArray, BodyPose, ObjectLoad, ObjectLoadArray
from casepush.msg import PushableObjectArray
from casepush.srv import Reset, SetLoad, SetPoses


class SimNodeTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.odometry = harness.Recorder("odom", Odometry)
        cls.tags = harness.Recorder("tag_detections", AprilTagDetectionArray)
        cls.truth = harness.Recorder("ground_truth/objects", PushableObjectArray)
        cls.clock = harness.Recorder("/clock", Clock)
        cls.command = rospy.Publisher("cmd_vel", Twist, queue_size=1, tcp_nodelay=True)
        rospy.wait_for_service("sim/set_pose", timeout=20)
        cls.set_pose = rospy.ServiceProxy("sim/set_pose", SetPoses)
        cls.odometry.wait()

    def drive(self, vx_mps, sim_s):
        """Commands at each odometry message for a while of simulated time."""
        end = self.odometry.last().header.stamp + rospy.Duration(sim_s)

        def step(message):
            self.command.publish(harness.twist(vx_mps))
            return message.header.stamp >= end

        return self.odometry.wait(step)

    def test_clock_runs_faster_than_real_time_when_nobody_commands(self):
        start = self.clock.wait().clock.to_sec()
        wall = time.monotonic()
        self.clock.wait(lambda message: message.clock.to_sec() > start + 5.0)
        self.assertLess(time.monotonic() - wall, 5.0)

    def test_odometry_comes_at_50_hz(self):
        self.odometry.clear()
        harness.wait_until(lambda: len(self.odometry.all()) >= 100)
        stamps = [message.header.stamp.to_sec() for _, message in self.odometry.all()]
        self.assertAlmostEqual((stamps[99] - stamps[0]) / 99, 0.02, delta=0.001)

    def test_transforms_lead_from_the_map_to_each_camera(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        for camera in ("front", "left", "back", "right"):
            frame = f"{camera}_optical_frame"
            harness.wait_until(lambda f=frame: buffer.can_transform("map", f, rospy.Time(0)),
                               what=frame)
        listener.unregister()

    def test_tags_are_seen_in_optical_frames(self):
        message = self.tags.wait(lambda m: len(m.detections) > 0)
        self.assertTrue(message.header.frame_id.endswith("_optical_frame"))
        detection = message.detections[0]
        self.assertEqual(len(detection.id), 1)
        # The chair stands 1.4 m away, in front of the camera.
        self.assertGreater(detection.pose.pose.pose.position.z, 0.3)
        self.assertLess(detection.pose.pose.pose.position.z, 2.5)

    def test_survey_is_latched(self):
        survey = harness.Recorder("survey", PointCloud2)
        message = survey.wait()
        self.assertEqual(message.header.frame_id, "map")
        self.assertGreater(message.width, 1000)

    def test_obeys_commands_and_stops_on_silence(self):
        # Backwards, away from the chair.
        self.drive(-0.3, 1.0)
        self.assertLess(self.odometry.last().twist.twist.linear.x, -0.2)
        silence = self.odometry.last().header.stamp.to_sec()
        stopped = self.odometry.wait(lambda m: abs(m.twist.twist.linear.x) < 0.02)
        self.assertLess(stopped.header.stamp.to_sec() - silence, 1.5)

    def test_ignores_commands_that_are_not_finite(self):
        self.drive(0.0, 0.3)
        before = self.odometry.last().pose.pose.position.x
        self.drive(math.nan, 1.0)
        self.assertAlmostEqual(self.odometry.last().pose.pose.position.x, before, delta=0.02)

    def test_warns_by_value_and_bound(self):
        log = harness.Recorder("/rosout", Log)

        def warned(vx_mps, words):
            self.command.publish(harness.twist(vx_mps))
            return any(all(word in m.msg for word in words) for _, m in log.all())

        for vx_mps, words in ((math.nan, ("cmd_vel is ignored", "nan m/s", "not finite")),
                              (7.0, ("cmd_vel is clamped", "7 m/s", "limit of"))):
            harness.wait_until(lambda v=vx_mps, w=words: warned(v, w), what=str(words))
        # Throttled: many commands, at most a line for each second of simulated time.
        self.drive(0.0, 0.1)
        log.clear()
        self.drive(math.nan, 2.5)
        lines = [m for _, m in log.all() if "cmd_vel is ignored" in m.msg]
        self.assertLessEqual(len(lines), 4)

    def test_puts_loads_on_objects(self):
        loads = harness.Recorder("ground_truth/loads", ObjectLoadArray)
        self.assertEqual(loads.wait().loads, [])
        set_load = rospy.ServiceProxy("sim/set_load", SetLoad)
        answer = set_load(ObjectLoad(id=harness.OBJECT, mass=30.0))
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.load.mass, 30.0)
        self.assertGreater(answer.load.centre.z, 0.4)  # On the seat.
        shown = loads.wait(lambda m: len(m.loads) == 1).loads[0]
        self.assertEqual((shown.id, shown.mass), (harness.OBJECT, 30.0))
        for load, words in ((ObjectLoad(id="piano", mass=1.0), "piano"),
                            (ObjectLoad(id=harness.OBJECT, mass=81.0), "[0, 80]"),
                            (ObjectLoad(id=harness.OBJECT, mass=math.nan), "[0, 80]"),
                            (ObjectLoad(id=harness.OBJECT, mass=5.0, centre=Point(3.0, 0.0, 0.0)),
                             "footprint")):
            answer = set_load(load)
            self.assertFalse(answer.success)
            self.assertIn(words, answer.message)
        self.assertTrue(set_load(ObjectLoad(id=harness.OBJECT, mass=0.0)).success)
        loads.wait(lambda m: not m.loads)

    def test_puts_bodies_somewhere(self):
        response = self.set_pose([BodyPose(harness.OBJECT, Pose2D(1.0, 2.0, 0.5)),
                                  BodyPose("robot", Pose2D(-1.4, 0.0, 0.0))])
        self.assertTrue(response.success, response.message)
        self.truth.wait(lambda m: abs(m.objects[0].pose.pose.position.y - 2.0) < 0.01)
        response = self.set_pose([BodyPose(harness.OBJECT, Pose2D(0.0, 0.0, 0.0))])
        self.assertTrue(response.success, response.message)

    def test_refuses_poses_that_cannot_be(self):
        for body, words in ((BodyPose("piano", Pose2D()), "piano"),
                            (BodyPose(harness.OBJECT, Pose2D(50.0, 0.0, 0.0)), ""),
                            (BodyPose(harness.OBJECT, Pose2D(4.9, 0.0, 0.0)), ""),
                            (BodyPose(harness.OBJECT, Pose2D(math.nan, 0.0, 0.0)), "finite")):
            response = self.set_pose([body])
            self.assertFalse(response.success)
            self.assertIn(words, response.message)
            self.assertNotEqual(response.message, "")

    def test_z_reset_starts_time_anew(self):
        before = self.clock.wait(lambda m: m.clock.to_sec() > 3.0)
        response = rospy.ServiceProxy("sim/reset", Reset)(7)
        self.assertTrue(response.success)
        self.clock.clear()
        self.clock.wait(lambda m: m.clock.to_sec() < before.clock.to_sec())


if __name__ == "__main__":
    rospy.init_node("sim_node_test")
    rostest.rosrun("casepush", "sim_node", SimNodeTest, sys.argv)
