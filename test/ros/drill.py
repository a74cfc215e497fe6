"""What the fault drills share: a task under way, a fault, and what must be true afterwards."""

import math
import os
import sqlite3
import time
import unittest
import xmlrpc.client

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist
from nav_msgs.msg import Odometry
from std_srvs.srv import Trigger

import fault_relay
import harness
from casepush.msg import (BodyPose, ExecutedPush, ExecutePushAction, ExecutorState, Octomap,
                          PushableObjectArray, PushCaseArray, PushObjectAction, PushObjectGoal)
from casepush.srv import ImportCases, SetPoses

STILL_MPS = 0.01
STILL_RPS = 0.02
# The limits of config/robots/cobot.yaml.
MAX_SPEED_MPS = 0.5
MAX_TURN_RPS = 1.0


def speeds(twist):
    return math.hypot(twist.linear.x, twist.linear.y), abs(twist.angular.z)


def moves(twist):
    speed, turn = speeds(twist)
    return speed > STILL_MPS or turn > STILL_RPS


def process_of(node):
    """The id of a node's process, also if roslaunch has started it anew."""
    node_uri = rospy.get_master().lookupNode("/" + node)[2]
    return xmlrpc.client.ServerProxy(node_uri).getPid("/drill")[2]


class Drill(unittest.TestCase):
    """Starts from a chair at the origin, a robot beside it and cases learnt before."""

    @classmethod
    def setUpClass(cls):
        cls.relay = fault_relay.FaultRelay()
        cls.commands = harness.Recorder("cmd_vel", Twist)
        cls.motion = harness.Recorder("raw/odom", Odometry)
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        cls.reports = harness.Recorder("push_reports", ExecutedPush)
        cls.state = harness.Recorder("executor/state", ExecutorState)
        cls.cases = harness.Recorder("cases", PushCaseArray)
        cls.map = harness.Recorder("map/octomap", Octomap)
        cls.push_object = actionlib.SimpleActionClient("push_object", PushObjectAction)
        cls.execute_push = actionlib.SimpleActionClient("execute_push", ExecutePushAction)
        cls.stop = rospy.ServiceProxy("stop", Trigger)
        cls.set_pose = rospy.ServiceProxy("sim/set_pose", SetPoses)
        cls.set_pose.wait_for_service(20.0)
        cls.await_nodes()
        importer = rospy.ServiceProxy("cases/import", ImportCases)
        importer.wait_for_service(20.0)
        answer = importer(os.path.join(harness.share(), "test/data/office_chair_cases.yaml"))
        assert answer.success, answer.message
        cls.cases.wait(lambda m: len(m.cases) == answer.count)
        cls.case_base = rospy.get_param("learner_node/case_base")

    @classmethod
    def tearDownClass(cls):
        for suffix in ("", "-wal", "-shm"):
            if os.path.exists(cls.case_base + suffix):
                os.remove(cls.case_base + suffix)

    @classmethod
    def await_nodes(cls):
        cls.map.wait()
        cls.stop.wait_for_service(20.0)
        for client in (cls.push_object, cls.execute_push):
            harness.wait_until(client.action_client.wait_for_server, what="the executor's actions")

    def setUp(self):
        self.relay.mend()
        self.place(robot=(-1.6, 0.6, 0.0), chair_1=(0.0, 0.0, 0.0), box_1=(4.4, 4.4, 0.0))
        self.objects.clear()
        self.objects.wait(lambda m: m.objects and not m.objects[0].moving and math.hypot(
            m.objects[0].pose.pose.position.x, m.objects[0].pose.pose.position.y) < 0.05)
        for recorder in (self.commands, self.motion, self.reports):
            recorder.clear()

    def tearDown(self):
        self.relay.mend()
        self.stop.wait_for_service(20.0)
        self.stop()

    def place(self, **poses):
        answer = self.set_pose([BodyPose(body, Pose2D(*pose)) for body, pose in poses.items()])
        self.assertTrue(answer.success, answer.message)

    def bar_the_way(self):
        """Away from the chair, with the box that nobody knows of in between: so near that every way
        to the chair leads through it."""
        self.place(robot=(-2.7, 0.2, 0.0), box_1=(-1.8, 0.2, math.pi / 2))

    def start(self, client, goal):
        """Sends a goal, again if a node has just been started and does not know of everything."""
        def attempt():
            client.send_goal(goal)
            sent = time.monotonic()
            harness.wait_until(lambda: client.get_state() != GoalStatus.PENDING or
                               time.monotonic() > sent + 3.0, what="an answer")
            return client.get_state() == GoalStatus.ACTIVE

        harness.wait_until(attempt, 30.0, "a goal to be accepted")

    def start_task(self, x_m=1.2, y_m=0.8, yaw_rad=0.5, time_limit_s=0.0):
        self.start(self.push_object, PushObjectGoal(
            object_id=harness.OBJECT, goal=harness.pose(x_m, y_m, yaw_rad), seed=1, adapt=True,
            time_limit=time_limit_s))

    def finish_task(self, patience_s=60.0):
        """The task's result. The robot stands afterwards, and no case is lost."""
        counts = self.case_counts()
        result = harness.result_of(self.push_object, patience_s)
        self.expect_still()
        for _, command in self.commands.all():
            speed, turn = speeds(command)
            self.assertLessEqual(speed, MAX_SPEED_MPS + 1e-6)
            self.assertLessEqual(turn, MAX_TURN_RPS + 1e-6)
        for before, after in zip(counts, self.case_counts()):
            self.assertGreaterEqual(after, before)
        return result

    def now(self):
        """[s] of simulated time, without the jumps of clocks."""
        return self.motion.last().header.stamp.to_sec()

    def wait_phase(self, *phases, patience_s=40.0):
        """Waits for the executor to come into a phase; it may have left it again already."""
        self.state.clear()
        harness.wait_until(lambda: any(m.phase in phases for _, m in self.state.all()), patience_s,
                           " or ".join(phases))

    def wait_moving(self):
        self.commands.wait(lambda command: speeds(command)[0] > 0.1)

    def expect_still(self, is_told_to=True):
        """The base comes to a stand within 2 s and stays there, as told."""
        began_s = self.now()
        harness.wait_until(lambda: self.now() > began_s + 4.0, what="time to pass")
        late = [m.header.stamp.to_sec() - began_s for _, m in self.motion.all()
                if m.header.stamp.to_sec() > began_s + 2.0 and moves(m.twist.twist)]
        self.assertEqual(late, [])
        if is_told_to and self.commands.all():
            self.assertTrue(harness.is_zero(self.commands.last()))

    def case_counts(self):
        """How many cases and observations are stored, if the file is intact."""
        with sqlite3.connect(f"file:{self.case_base}?mode=ro", uri=True) as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
            return [database.execute(f"SELECT COUNT(*) FROM {table}").fetchone()[0]
                    for table in ("cases", "outcomes")]
