"""What tests share that have a robot push a chair: topics, actions and services, and a scene."""

import math
import time
import unittest

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D, Twist
from std_srvs.srv import Trigger

import harness
from casepush.msg import (BodyPose, ExecutedPush, ExecutePushAction, ExecutorState, Octomap,
                          PushableObjectArray, PushCaseArray, PushObjectAction)
from casepush.srv import SetPoses


def speeds(twist):
    """Of a Twist: [m/s] and [rad/s]."""
    return math.hypot(twist.linear.x, twist.linear.y), abs(twist.angular.z)


class PushingTest(unittest.TestCase):
    """Knows the nodes' interfaces. Whether there are nodes is up to await_nodes()."""

    @classmethod
    def setUpClass(cls):
        cls.commands = harness.Recorder("cmd_vel", Twist)
        cls.objects = harness.Recorder("objects", PushableObjectArray)
        cls.reports = harness.Recorder("push_reports", ExecutedPush)
        cls.state = harness.Recorder("executor/state", ExecutorState)
        cls.cases = harness.Recorder("cases", PushCaseArray)
        cls.map = harness.Recorder("map/octomap", Octomap)
        cls.push_object = actionlib.SimpleActionClient("push_object", PushObjectAction)
        cls.execute_push = actionlib.SimpleActionClient("execute_push", ExecutePushAction)
        cls.stop = rospy.ServiceProxy("stop", Trigger)
        cls.set_pose = rospy.ServiceProxy("sim/set_pose", SetPoses)

    @classmethod
    def await_nodes(cls):
        """Waits for simulator, planner and executor; they may just have been started again."""
        cls.map.wait()
        for service in (cls.set_pose, cls.stop):
            service.wait_for_service(30.0)
        for client in (cls.push_object, cls.execute_push):
            harness.wait_until(client.action_client.wait_for_server, what="the executor's actions")

    def place(self, **poses):
        """Puts bodies somewhere: (x [m], y [m], yaw [rad]) by id."""
        answer = self.set_pose([BodyPose(body, Pose2D(*pose)) for body, pose in poses.items()])
        self.assertTrue(answer.success, answer.message)

    def set_scene(self, **others):
        """The chair at the origin, seen at rest, and the robot beside it."""
        self.place(robot=(-1.6, 0.6, 0.0), chair_1=(0.0, 0.0, 0.0), **others)
        self.objects.clear()
        self.objects.wait(lambda m: m.objects and not m.objects[0].moving and math.hypot(
            m.objects[0].pose.pose.position.x, m.objects[0].pose.pose.position.y) < 0.05)
        self.commands.clear()

    def start(self, client, goal, patience_s=40.0):
        """Sends a goal, again if a node has just been started and does not know of everything."""
        def attempt():
            client.send_goal(goal)
            sent = time.monotonic()
            harness.wait_until(lambda: client.get_state() != GoalStatus.PENDING or
                               time.monotonic() > sent + 3.0, what="an answer")
            return client.get_state() == GoalStatus.ACTIVE

        harness.wait_until(attempt, patience_s, "a goal to be accepted")

    def wait_moving(self):
        self.commands.wait(lambda command: speeds(command)[0] > 0.1)
