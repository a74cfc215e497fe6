#!/usr/bin/env python3
"""What the simulated robot senses: scans, odometry, the chain of frames, and their switches.

Two simulators of the same world run: one as it is shipped, and one without noise in the namespace
`exact`. Nobody commands them, so both robots stand still.
"""

import math
import sys
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from nav_msgs.msg import Odometry
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage

import harness
from casepush.msg import AprilTagDetectionArray

START = (-1.4, 0.0)  # Of the robot in open_floor.
SCANNER_X, SCANNER_Z = 0.2, 0.42
INNER_WALL = 4.9


def points_of(message):
    """layers x beams x 3, NaN where there was no return."""
    assert [(f.name, f.offset, f.datatype) for f in message.fields] == [
        ("x", 0, 7), ("y", 4, 7), ("z", 8, 7)]
    return np.frombuffer(message.data, np.float32).reshape(message.height, message.width, 3)


class Poses:
    """map -> odom and odom -> base_link as they come, by stamp."""

    def __init__(self, topic):
        self.recorder = harness.Recorder(topic, TFMessage)

    def latest(self):
        def both(message):
            return {t.header.frame_id for t in message.transforms} == {"map", "odom"}

        message = self.recorder.wait(both)
        return {t.header.frame_id: t for t in message.transforms}


def compose(a, b):
    yaw = a[2] + b[2]
    return (a[0] + math.cos(a[2]) * b[0] - math.sin(a[2]) * b[1],
            a[1] + math.sin(a[2]) * b[0] + math.cos(a[2]) * b[1],
            math.atan2(math.sin(yaw), math.cos(yaw)))


def planar(transform):
    return (transform.translation.x, transform.translation.y, harness.yaw_of(transform.rotation))


class SimSensorsTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.scans = harness.Recorder("points", PointCloud2)
        cls.exact_scans = harness.Recorder("exact/points", PointCloud2)
        cls.odometry = harness.Recorder("odom", Odometry)
        cls.tags = harness.Recorder("tag_detections", AprilTagDetectionArray)
        cls.exact_tags = harness.Recorder("exact/tag_detections", AprilTagDetectionArray)
        cls.poses = Poses("/tf")
        cls.exact_poses = Poses("exact/tf")
        cls.scans.wait()

    def test_scans_are_organised_and_come_in_the_frame_of_the_sensor(self):
        message = self.scans.wait()
        self.assertEqual(message.header.frame_id, "scanner_frame")
        self.assertEqual((message.height, message.width), (8, 271))
        self.assertFalse(message.is_dense)
        self.assertEqual(message.row_step, 271 * message.point_step)

    def test_scans_come_at_10_hz_after_their_latency(self):
        self.scans.clear()
        harness.wait_until(lambda: len(self.scans.all()) >= 30)
        stamps = [message.header.stamp.to_sec() for _, message in self.scans.all()]
        self.assertAlmostEqual((stamps[29] - stamps[0]) / 29, 0.1, delta=0.005)

    def test_scans_show_chair_and_walls_of_the_map(self):
        points = points_of(self.exact_scans.wait())
        self.assertTrue(np.all(np.isnan(points) == np.isnan(points[..., :1])))
        hits = points[np.isfinite(points[..., 0])]
        x = hits[:, 0] + SCANNER_X + START[0]
        y = hits[:, 1] + START[1]
        z = hits[:, 2] + SCANNER_Z
        self.assertGreater(len(hits), 1000)
        self.assertGreater(z.min(), -1e-3)
        for coordinate in (x, y):
            self.assertLess(np.abs(coordinate).max(), INNER_WALL + 1e-2)
        floor = z < 1e-3
        chair = ~floor & (np.hypot(x, y) < 0.5)
        wall = np.maximum(np.abs(x), np.abs(y)) > INNER_WALL - 1e-2
        self.assertGreater(np.count_nonzero(chair), 30)
        self.assertTrue(np.all(floor | chair | wall))

    def test_noise_differs_from_scan_to_scan_unless_switched_off(self):
        self.exact_scans.clear()
        harness.wait_until(lambda: len(self.exact_scans.all()) >= 3)
        exact = [points_of(message) for _, message in self.exact_scans.all()]
        np.testing.assert_allclose(exact[0], exact[2], atol=1e-4)
        self.scans.clear()
        harness.wait_until(lambda: len(self.scans.all()) >= 3)
        noisy = [points_of(message) for _, message in self.scans.all()[:3]]
        ranges = [np.linalg.norm(points, axis=2) for points in noisy]
        difference = (ranges[0] - ranges[2])[np.isfinite(ranges[0] + ranges[2])]
        # sqrt(2) (1 cm + 0.2 % of some metres).
        self.assertGreater(difference.std(), 0.012)
        self.assertLess(difference.std(), 0.04)
        dropped = np.count_nonzero(np.isnan(ranges[0])) - np.count_nonzero(np.isnan(exact[0][..., 0]))
        self.assertGreater(dropped, 3)

    def test_frames_lead_from_the_map_to_the_scanner(self):
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        harness.wait_until(lambda: buffer.can_transform("map", "scanner_frame", rospy.Time(0)))
        transform = buffer.lookup_transform("base_link", "scanner_frame", rospy.Time(0)).transform
        self.assertAlmostEqual(transform.translation.x, SCANNER_X)
        self.assertAlmostEqual(transform.translation.z, SCANNER_Z)
        self.assertAlmostEqual(transform.rotation.w, 1.0)
        listener.unregister()

    def test_map_to_odom_to_base_is_the_estimate_within_its_bounds(self):
        errors = []

        def collect(_):
            frames = self.poses.latest()
            self.assertEqual(frames["map"].child_frame_id, "odom")
            self.assertEqual(frames["odom"].child_frame_id, "base_link")
            self.assertEqual(frames["map"].header.stamp, frames["odom"].header.stamp)
            pose = compose(planar(frames["map"].transform), planar(frames["odom"].transform))
            errors.append((pose[0] - START[0], pose[1] - START[1], pose[2]))
            return errors[-1] != errors[0]

        harness.wait_until(lambda: collect(None))
        for error in errors:
            self.assertLessEqual(math.hypot(error[0], error[1]), 0.0121)
            self.assertLessEqual(abs(error[2]), math.radians(0.35))

    def test_without_noise_the_pose_is_exact(self):
        frames = self.exact_poses.latest()
        pose = compose(planar(frames["map"].transform), planar(frames["odom"].transform))
        for value, expected in zip(pose, (*START, 0.0)):
            self.assertAlmostEqual(value, expected, delta=1e-6)

    def test_odometry_agrees_with_the_frames(self):
        message = self.odometry.wait()
        self.assertEqual(message.header.frame_id, "odom")
        self.assertEqual(message.child_frame_id, "base_link")

        def same_time():
            odometry = {m.header.stamp: m for _, m in self.odometry.all()}
            frame = self.poses.latest()["odom"]
            found = odometry.get(frame.header.stamp)
            if found is None:
                return False
            self.assertAlmostEqual(found.pose.pose.position.x, frame.transform.translation.x)
            self.assertAlmostEqual(found.pose.pose.orientation.z, frame.transform.rotation.z)
            return True

        harness.wait_until(same_time)

    def test_disabled_cameras_are_silent(self):
        def cameras(recorder):
            return {m.header.frame_id.replace("_optical_frame", "") for _, m in recorder.all()}

        harness.wait_until(lambda: len(cameras(self.tags)) == 4)
        harness.wait_until(lambda: len(self.exact_tags.all()) > 20)
        self.assertEqual(cameras(self.exact_tags), {"front"})

    def test_unknown_sensors_are_refused(self):
        code, text = harness.run_node("sim_node", "_world:=open_floor",
                                      "_disabled_sensors:=front sonar",
                                      "_exact_sensors:=compass")
        self.assertEqual(code, 2, text)
        self.assertIn("disabled_sensors: robot cobot: has no sensor 'sonar'", text)
        self.assertIn("exact_sensors: robot cobot: has no sensor 'compass'", text)


if __name__ == "__main__":
    rospy.init_node("sim_sensors_test")
    rostest.rosrun("casepush", "sim_sensors", SimSensorsTest, sys.argv)
