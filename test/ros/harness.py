"""What the ROS tests share: waiting on conditions, recording topics, made-up cases."""

import math
import subprocess
import threading
import time

import rospkg
import rospy
from actionlib_msgs.msg import GoalStatus
from geometry_msgs.msg import Pose2D
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Twist

from casepush.msg import PushCase
from casepush.msg import PushCaseArray
from casepush.msg import PushSample

OBJECT = "chair_1"
# Between the centres of chair and robot at the start of a made-up push.
REACH_M = 0.75


class Recorder:
    """Keeps the messages of a topic with the wall time of their arrival."""

    def __init__(self, topic, message_type, keep=10000):
        self._condition = threading.Condition()
        self._messages = []
        self._keep = keep
        self._subscriber = rospy.Subscriber(topic, message_type, self._add, tcp_nodelay=True)

    def _add(self, message):
        with self._condition:
            self._messages.append((time.monotonic(), message))
            del self._messages[:-self._keep]
            self._condition.notify_all()

    def clear(self):
        with self._condition:
            self._messages.clear()

    def all(self):
        with self._condition:
            return list(self._messages)

    def last(self):
        with self._condition:
            return self._messages[-1][1] if self._messages else None

    def wait(self, condition=lambda message: True, patience_s=20.0):
        """The last message once it fulfils the condition; fails the test if none does in time."""
        end = time.monotonic() + patience_s
        with self._condition:
            while not self._messages or not condition(self._messages[-1][1]):
                left = end - time.monotonic()
                if left <= 0.0:
                    raise AssertionError(f"waited {patience_s} s in vain on a topic; last message: "
                                         f"{self._messages[-1][1] if self._messages else None}")
                self._condition.wait(left)
            return self._messages[-1][1]


def wait_until(condition, patience_s=20.0, what="a condition"):
    """Waits for a condition on something that does not tell of its changes."""
    end = time.monotonic() + patience_s
    pause = threading.Event()
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"waited {patience_s} s in vain for {what}")
        pause.wait(0.02)


def result_of(client, patience_s=30.0):
    """The result of the goal that a SimpleActionClient sent; the state may come before it."""
    wait_until(lambda: client.get_state() > GoalStatus.ACTIVE and client.get_result() is not None,
               patience_s, "a result")
    return client.get_result()


def node_path(executable):
    """The program itself; rosrun would be a process in between that a signal does not pass."""
    found = subprocess.run(["catkin_find", "--first-only", "--libexec", "casepush", executable],
                           capture_output=True, text=True, check=True).stdout.strip()
    assert found, f"{executable} is not built"
    return found


def start_node(executable, *parameters):
    """Starts a node outside of roslaunch, so that a test can stop or kill it."""
    return subprocess.Popen([node_path(executable), f"__name:={executable}", *parameters])


def end_node(process):
    """Ends a node that start_node started, also if it was stopped or is gone already."""
    if process.poll() is None:
        process.kill()
        process.wait()


def run_node(executable, *parameters, timeout_s=20.0):
    """Runs a node that should end by itself. Returns exit code and stderr."""
    ended = subprocess.run([node_path(executable), f"__name:=checked_{executable}", *parameters],
                           capture_output=True, text=True, timeout=timeout_s, check=False)
    return ended.returncode, ended.stderr


def share():
    return rospkg.RosPack().get_path("casepush")


def pose(x_m, y_m, yaw_rad, frame="map"):
    stamped = PoseStamped()
    stamped.header.frame_id = frame
    stamped.pose.position.x = x_m
    stamped.pose.position.y = y_m
    stamped.pose.orientation.z = math.sin(yaw_rad / 2)
    stamped.pose.orientation.w = math.cos(yaw_rad / 2)
    return stamped


def yaw_of(quaternion):
    return 2.0 * math.atan2(quaternion.z, quaternion.w)


def is_zero(twist):
    return twist.linear.x == 0.0 and twist.linear.y == 0.0 and twist.angular.z == 0.0


def made_up_case(number, bearing_rad, turn_rad, length_m=0.5):
    """A push towards `bearing_rad` in the object's frame that turns the object by `turn_rad`."""
    case = PushCase(id=number, object="office_chair", robot="cobot", period=0.1, push_steps=21,
                    effective_count=20, observation_count=20)
    count = 26
    for i in range(count):
        fraction = min(1.0, i / 20.0)
        travel = fraction * length_m
        x, y = travel * math.cos(bearing_rad), travel * math.sin(bearing_rad)
        yaw = fraction * turn_rad
        # The robot stays behind the object; seen from the turning object it goes the other way.
        angle = bearing_rad - yaw
        sample = PushSample()
        sample.object_T_robot = Pose2D(-REACH_M * math.cos(angle), -REACH_M * math.sin(angle),
                                       angle)
        sample.start_T_object = Pose2D(x, y, yaw)
        sample.vx = 0.25 if i < 20 else 0.0
        case.steps.append(sample)
    case.outcome.mean = case.steps[-1].start_T_object
    case.outcome.covariance = [4e-4, 0, 0, 0, 4e-4, 0, 0, 0, 1e-3]
    return case


def made_up_cases():
    cases = PushCaseArray()
    bearings = [2.0 * math.pi * k / 12 for k in range(12)]
    for bearing in bearings:
        for turn in (-0.4, 0.0, 0.4):
            cases.cases.append(made_up_case(len(cases.cases) + 1, bearing, turn))
    return cases


def latched_cases():
    """Publishes made-up cases instead of a learner. Keep the publisher."""
    publisher = rospy.Publisher("cases", PushCaseArray, queue_size=1, latch=True)
    publisher.publish(made_up_cases())
    return publisher


def twist(vx_mps):
    message = Twist()
    message.linear.x = vx_mps
    return message
