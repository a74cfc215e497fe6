#!/usr/bin/env python3
"""Lock-step: time stands still but for sim/step, and the same steps give the same world."""

import hashlib
import io
import math
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock

import harness
from casepush.msg import AprilTagDetectionArray, BodyPose, ObjectLoad, PushableObjectArray
from casepush.srv import Reset, SetLoad, SetPoses, StepSimulation

STEP_S = 1.0 / 240.0
# Beside the chair, facing it: a push to and fro.
START = BodyPose("robot", Pose2D(-0.85, 0.1, 0.0))


def end_of_period(number):
    """Simulated time of the physics step nearest to the end of a control period of 20 ms."""
    return math.ceil(4.8 * number - 0.5) * STEP_S


def periods_in(steps):
    return int((steps + 0.5) / 4.8 + 1e-9)


def digest(messages):
    """Hash over all that messages hold but their running number."""
    total = hashlib.sha256()
    for message in messages:
        message.header.seq = 0
        buffer = io.BytesIO()
        message.serialize(buffer)
        total.update(buffer.getvalue())
    return total.hexdigest()


class World:
    """One simulator: its services, and what it published."""

    def __init__(self, namespace):
        self.odometry = harness.Recorder(f"{namespace}/odom", Odometry)
        self.truth = harness.Recorder(f"{namespace}/ground_truth/objects", PushableObjectArray)
        self.tags = harness.Recorder(f"{namespace}/tag_detections", AprilTagDetectionArray)
        self.clock = harness.Recorder(f"{namespace}/clock", Clock)
        self.command = rospy.Publisher(f"{namespace}/cmd_vel", Twist, queue_size=1)
        rospy.wait_for_service(f"{namespace}/sim/step", timeout=20)
        self.step = self.service(f"{namespace}/sim/step", StepSimulation)
        self.reset = self.service(f"{namespace}/sim/reset", Reset)
        self.set_pose = self.service(f"{namespace}/sim/set_pose", SetPoses)
        self.set_load = self.service(f"{namespace}/sim/set_load", SetLoad)
        self.clock.wait()
        harness.wait_until(lambda: self.command.get_num_connections() > 0, what="cmd_vel")

    @staticmethod
    def service(name, kind):
        return rospy.ServiceProxy(name, kind, persistent=True)

    def catch_up(self):
        """Waits for all odometry and truth up to now."""
        count = self.step(0, False, Twist()).step_count
        last = periods_in(count)
        for recorder, period in ((self.odometry, last), (self.truth, last - (last - 1) % 5)):
            if last > 0:
                recorder.wait(lambda m, s=end_of_period(period):
                              abs(m.header.stamp.to_sec() - s) < 0.5 * STEP_S)

    def restart(self, seed=5):
        self.catch_up()
        assert self.reset(seed).success
        assert self.set_pose([START]).success
        for recorder in (self.odometry, self.truth, self.tags):
            recorder.clear()

    def drive(self, seconds, batch):
        """To and fro against the chair; the command is a function of the step. Returns hashes over
        all that was published."""
        end = int(240 * seconds)
        count = self.step(0, False, Twist()).step_count
        while count < end:
            command = harness.twist(0.45 if count // 480 % 3 < 2 else -0.4)
            command.angular.z = 0.3 * math.sin(0.001 * count)
            # Commands come every 24 steps; in between, time may stop anywhere.
            steps = min(batch, 24 - count % 24)
            answer = self.step(steps, count % 24 == 0, command)
            assert answer.success, answer.message
            count = answer.step_count
        self.catch_up()
        return [digest(m for _, m in recorder.all())
                for recorder in (self.odometry, self.truth)]


class LockStepTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.featherstone = World("featherstone")
        cls.planar = World("planar")

    def test_time_stands_still_until_asked(self):
        world = self.planar
        world.restart()
        first = world.step(7, False, Twist())
        self.assertTrue(first.success, first.message)
        self.assertEqual(first.step_count, 7)
        self.assertAlmostEqual(first.clock.to_sec(), 7 * STEP_S, places=6)
        world.clock.wait(lambda m: m.clock == first.clock)
        world.clock.clear()
        # It tells the time again and again, and it is the same time.
        harness.wait_until(lambda: len(world.clock.all()) >= 3)
        self.assertEqual({m.clock for _, m in world.clock.all()}, {first.clock})
        again = world.step(0, False, Twist())
        self.assertEqual((again.step_count, again.clock), (7, first.clock))

    def test_sensors_come_at_the_same_times_as_otherwise(self):
        world = self.planar
        world.restart()
        for _ in range(96):
            world.step(5, False, Twist())
        world.catch_up()
        stamps = [m.header.stamp.to_sec() for _, m in world.odometry.all()]
        self.assertEqual(len(stamps), 100)
        for k, stamp in enumerate(stamps):
            self.assertAlmostEqual(stamp, end_of_period(k + 1), places=6)

    def test_a_command_holds_for_a_fifth_of_a_second_of_simulated_time(self):
        world = self.planar
        world.restart()  # Odometry is noisy.
        world.step(48, True, harness.twist(-0.4))
        world.catch_up()
        self.assertAlmostEqual(world.odometry.last().twist.twist.linear.x, -0.4, delta=0.05)
        world.step(48, False, Twist())
        world.catch_up()
        self.assertAlmostEqual(world.odometry.last().twist.twist.linear.x, 0.0, delta=0.02)

    def test_a_command_by_topic_takes_effect_at_the_next_step(self):
        world = self.planar
        world.restart()

        def moves():
            world.command.publish(harness.twist(-0.4))
            world.step(5, False, Twist())
            last = world.odometry.last()
            return last is not None and last.twist.twist.linear.x < -0.3

        harness.wait_until(moves, what="the robot to move")

    def test_a_minute_repeats_bit_by_bit_however_it_is_cut(self):
        for name, batches in (("planar", (24, 7)), ("featherstone", (24, 24))):
            world = getattr(self, name)
            world.restart()
            start = world.truth
            first = world.drive(60.0, batches[0])
            moved = start.last().objects[0].pose.pose.position
            self.assertGreater(math.hypot(moved.x, moved.y), 0.3, "the chair was not pushed")
            world.step(100, True, harness.twist(0.1))
            world.set_load(ObjectLoad(id=harness.OBJECT, mass=20.0))
            world.restart()
            self.assertEqual(world.drive(60.0, batches[1]), first, name)
            world.restart(seed=6)
            self.assertNotEqual(world.drive(2.0, 24), first, name)

    def test_a_paced_world_sees_the_same(self):
        paced = World("paced")
        self.planar.reset(5)
        self.planar.tags.clear()
        paced.tags.clear()
        paced.reset(5)
        paced.tags.wait(lambda m: 1.0 < m.header.stamp.to_sec() < 2.0)
        self.planar.step(480, False, Twist())
        self.planar.tags.wait(lambda m: m.header.stamp.to_sec() > 1.9)

        def by_stamp(world):
            messages = [m for _, m in world.tags.all() if 0.2 < m.header.stamp.to_sec() < 1.0]
            return {(m.header.stamp, m.header.frame_id): digest([m]) for m in messages}

        ours = by_stamp(self.planar)
        self.assertGreater(len(ours), 20)
        self.assertEqual(by_stamp(paced), ours)
        refused = paced.step(5, False, Twist())
        self.assertFalse(refused.success)
        self.assertIn("lock_step: true", refused.message)

    def test_refuses_what_cannot_be(self):
        world = self.planar
        world.restart()
        for steps, vx, word in ((100001, 0.0, "must be at most 100000"),
                                (5, math.nan, "is not finite")):
            answer = world.step(steps, True, harness.twist(vx))
            self.assertFalse(answer.success)
            self.assertIn(word, answer.message)
            self.assertEqual(answer.step_count, 0)
        clamped = world.step(5, True, harness.twist(3.0))
        self.assertTrue(clamped.success)
        self.assertIn("the speed is 3 m/s, above the limit of", clamped.message)


if __name__ == "__main__":
    rospy.init_node("lock_step_test")
    rostest.rosrun("casepush", "lock_step", LockStepTest, sys.argv)
