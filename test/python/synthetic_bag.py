"""Writes a small made-up recording with the package's messages: a chair is learnt, then pushed."""

import math
import random

import numpy as np
import rosbag
import rospy
import struct
from casepush import msg
from casepush_analysis.se2 import Pose2
from geometry_msgs.msg import Pose2D, PoseStamped, TransformStamped
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage

CHAIR = 'chair_1'
PERIOD_S = 0.1
SIGMA = (0.04, 0.03, 0.08)  # Of every case's outcome [m, m, rad].
APPROACH_S, PUSH_S, REST_S = 4.0, 2.0, 1.0


def pose2d(pose):
    return Pose2D(pose.x_m, pose.y_m, pose.yaw_rad)


def gaussian(mean):
    diagonal = np.diag(np.square(SIGMA))
    return msg.Pose2DWithCovariance(pose2d(mean), diagonal.ravel().tolist())


def chi_square_3(value):
    """Probability that a chi-square variable with 3 degrees of freedom exceeds `value`."""
    return (math.erfc(math.sqrt(value / 2.0))
            + math.sqrt(2.0 * value / math.pi) * math.exp(-value / 2.0))


def set_pose(target, pose):
    target.position.x, target.position.y = pose.x_m, pose.y_m
    target.orientation.z = math.sin(pose.yaw_rad / 2.0)
    target.orientation.w = math.cos(pose.yaw_rad / 2.0)


class Story:
    """Tells the recording message by message, with a clock of its own."""

    def __init__(self, bag, seed):
        self._bag = bag
        self._random = random.Random(seed)
        self.time_s = 10.0
        self.chair = Pose2(2.0, 2.0, 0.3)
        self.robot = Pose2(1.0, 1.0, 0.0)
        self.sequence = 0
        self.plan_number = 0
        self.cases = []

    def write(self, topic, message):
        stamp = rospy.Time.from_sec(self.time_s)
        if hasattr(message, 'header'):
            message.header.stamp = stamp
            message.header.frame_id = 'map'
        self._bag.write(topic, message, stamp)

    def wait(self, duration_s, phase, activity, towards=None):
        """Time passes in a phase while the chair moves straight to `towards`."""
        self.write('/executor/state', msg.ExecutorState(phase=phase, activity=activity))
        steps, start = max(1, round(duration_s / PERIOD_S)), self.chair
        goal = start if towards is None else towards
        turn = start.yaw_difference_rad(goal)
        for step in range(1, steps + 1):
            t = step / steps
            self.chair = Pose2(start.x_m + t * (goal.x_m - start.x_m),
                               start.y_m + t * (goal.y_m - start.y_m), start.yaw_rad + t * turn)
            self.time_s += PERIOD_S
            self.observe()

    def observe(self):
        for topic, sigma in (('/ground_truth/objects', 0.0), ('/objects', 0.01)):
            noisy = Pose2(self.chair.x_m + self._random.gauss(0.0, sigma),
                          self.chair.y_m + self._random.gauss(0.0, sigma), self.chair.yaw_rad)
            body = msg.PushableObject(id=CHAIR, model='office_chair')
            set_pose(body.pose.pose, noisy)
            self.write(topic, msg.PushableObjectArray(objects=[body]))
        behind = self.chair @ Pose2(-0.7, 0.0, 0.0)
        for parent, child, pose in (('map', 'odom', Pose2(0.1, 0.0, 0.0)),
                                    ('odom', 'base_link', Pose2(-0.1, 0.0, 0.0) @ behind)):
            link = TransformStamped(child_frame_id=child)
            link.header.frame_id = parent
            link.transform.translation.x, link.transform.translation.y = pose.x_m, pose.y_m
            link.transform.rotation.z = math.sin(pose.yaw_rad / 2.0)
            link.transform.rotation.w = math.cos(pose.yaw_rad / 2.0)
            self.write('/tf', TFMessage([link]))

    def draw_outcome(self, mean, bias_m=0.0):
        error = [self._random.gauss(0.0, s) for s in SIGMA]
        error[0] += bias_m
        end = mean @ Pose2(*error)
        t_squared = sum((e / s) ** 2 for e, s in zip(error, SIGMA))
        return end, t_squared, chi_square_3(t_squared)

    def push(self, case, activity, plan_number=0, push_index=0, practice=True, bias_m=0.0):
        """One push from approach to rest, and its report."""
        self.wait(APPROACH_S, 'approach', activity)
        start, start_s = self.chair, self.time_s
        mean = start @ Pose2(case.outcome.mean.x, case.outcome.mean.y, case.outcome.mean.theta)
        end, t_squared, p_value = self.draw_outcome(mean, bias_m)
        self.wait(PUSH_S, 'push', activity, end)
        self.wait(REST_S, 'rest', activity)
        self.sequence += 1
        report = msg.ExecutedPush(
            sequence=self.sequence, plan_number=plan_number, push_index=push_index,
            object_id=CHAIR, case_id=case.id if practice else 0, outcome=msg.ExecutedPush.DONE,
            start_stamp=rospy.Time.from_sec(start_s), end_stamp=rospy.Time.from_sec(self.time_s),
            start=pose2d(start), expected=gaussian(mean), observed=pose2d(self.chair),
            recorded=msg.PushCase(period=PERIOD_S, push_steps=round(PUSH_S / PERIOD_S),
                                  steps=case.steps))
        if practice:
            report.t_squared, report.p_value = t_squared, p_value
            report.rejected = p_value < 0.01
        self.write('/push_reports', report)
        return report.rejected

    def make_case(self, number, direction_rad):
        """A straight push that turns the chair a little."""
        length = 0.5 + 0.1 * (number % 4)
        end = Pose2(length * math.cos(direction_rad), length * math.sin(direction_rad),
                    0.2 * (number % 3 - 1))
        steps = []
        for step in range(31):
            t = 1.0 - (1.0 - step / 30.0) ** 2
            where = Pose2(t * end.x_m, t * end.y_m + 0.05 * math.sin(math.pi * t), t * end.yaw_rad)
            robot = Pose2(-0.7 * math.cos(direction_rad), -0.7 * math.sin(direction_rad),
                          direction_rad)
            steps.append(msg.PushSample(object_T_robot=pose2d(robot), start_T_object=pose2d(where),
                                        vx=0.3))
        return msg.PushCase(id=number, object='office_chair', robot='cobot', period=PERIOD_S,
                            push_steps=20, steps=steps, outcome=gaussian(end), effective_count=20.0,
                            observation_count=20)

    def learn(self, cases, practices):
        goal = msg.LearnObjectActionGoal()
        goal.goal_id.id = 'learn-1'
        goal.goal.object_id = CHAIR
        self.write('/learn_object/goal', goal)
        for number in range(1, cases + 1):
            self.cases.append(self.make_case(number, 2.0 * math.pi * number / cases))
            for practice in range(practices):
                self.chair = Pose2(2.0, 2.0, 0.3)
                self.push(self.cases[-1], msg.ExecutorState.EXECUTING_PUSH, practice=practice > 0)
            self.write('/cases', msg.PushCaseArray(cases=self.cases))
        self.write('/executor/state', msg.ExecutorState())
        result = msg.LearnObjectActionResult()
        result.status.goal_id.id = 'learn-1'
        result.result = msg.LearnObjectResult(cases=cases, pushes=cases * practices, discarded=2)
        self.write('/learn_object/result', result)

    def plan(self, goal):
        """Chains the case that comes nearest to the goal until none comes nearer."""
        self.wait(0.5, 'planning', msg.ExecutorState.PUSHING_OBJECT)
        here, pushes = self.chair, []
        self.plan_number += 1
        plan = msg.Plan(number=self.plan_number, goal=pose2d(goal))
        plan.object = msg.ObjectPose(id=CHAIR, model='office_chair', pose=pose2d(here))
        while here.distance_m(goal) > 0.4 and len(pushes) < 40:
            ends = [(here @ Pose2(c.outcome.mean.x, c.outcome.mean.y, c.outcome.mean.theta), c)
                    for c in self.cases]
            end, case = min(ends, key=lambda e: e[0].distance_m(goal))
            pushes.append((case, end))
            plan.pushes.append(msg.PlanStep(case_id=case.id, start=pose2d(here), outcome=gaussian(end)))
            plan.length += here.distance_m(end)
            here = end
        self.write('/plan', plan)
        result = msg.PlanPushActionResult()
        result.result = msg.PlanPushResult(plan=plan, nodes=120, planning_time=0.25)
        self.write('/plan_push/result', result)
        return [case for case, _ in pushes]

    def push_to(self, goal, name='task-1'):
        """The task: pushes until the chair is there; a rejected prediction makes a new plan."""
        request = msg.PushObjectActionGoal()
        request.goal_id.id = name
        request.goal.object_id = CHAIR
        request.goal.goal = PoseStamped()
        request.goal.position_tolerance = 0.5
        request.goal.yaw_tolerance = math.pi
        set_pose(request.goal.goal.pose, goal)
        self.write('/push_object/goal', request)
        plan_number, pushes = 0, 0
        summary = msg.TaskSummary(goal_id=name, object_id=CHAIR, goal=pose2d(goal),
                                  position_tolerance=0.5, yaw_tolerance=math.pi,
                                  start_stamp=rospy.Time.from_sec(self.time_s),
                                  status='succeeded', explanation='the goal is reached',
                                  repairs=2)
        while self.chair.distance_m(goal) > 0.45 and pushes < 60:
            plan_number += 1
            for index, case in enumerate(self.plan(goal), 1):
                pushes += 1
                bias_m = 0.25 if pushes == 3 else 0.0
                if self.push(case, msg.ExecutorState.PUSHING_OBJECT, plan_number, index,
                             bias_m=bias_m):
                    summary.replan_causes.append('prediction_rejected')
                    summary.replan_reasons.append('the chair rests elsewhere than predicted')
                    break
            else:
                summary.replan_causes.append('ended_beside_goal')
                summary.replan_reasons.append('the plan ended beside the goal')
        if summary.replan_causes and len(summary.replan_causes) == plan_number:
            del summary.replan_causes[-1], summary.replan_reasons[-1]  # The last plan succeeded.
        self.write('/task_summaries', summary)
        result = msg.PushObjectActionResult()
        result.status.goal_id.id = name
        result.result = msg.PushObjectResult(status=msg.PushObjectResult.SUCCEEDED, pushes=pushes,
                                             explanation='the goal is reached')
        self.write('/push_object/result', result)
        self.write('/executor/state', msg.ExecutorState(description='done'))

    def touch(self, body, obstacle, impulse_ns):
        contact = msg.BodyContact(body_a=obstacle, part_a='', body_b=body, part_b='base',
                                  impulse=impulse_ns)
        self.write('/contacts', msg.BodyContactArray(contacts=[contact]))


def room_points(size_m=15.0):
    """Walls around a square room and a table in it."""
    points = []
    for along in np.arange(0.0, size_m, 0.05):
        for z in np.arange(0.0, 1.5, 0.25):
            points += [(along, 0.0, z), (along, size_m, z), (0.0, along, z), (size_m, along, z)]
    for x in np.arange(6.0, 7.5, 0.05):
        points += [(x, y, 0.7) for y in np.arange(2.0, 4.0, 0.05)]
    cloud = PointCloud2(height=1, width=len(points), point_step=12, row_step=12 * len(points))
    cloud.fields = [PointField(axis, 4 * i, PointField.FLOAT32, 1) for i, axis in enumerate('xyz')]
    cloud.data = b''.join(struct.pack('<fff', *p) for p in points)
    return cloud


def write_demo(path, cases=6, practices=4, task=True, seed=1, goal=Pose2(9.0, 8.0, 0.0)):
    """A whole demo, or only its learning part. Returns the story for what tests want to know."""
    with rosbag.Bag(str(path), 'w') as bag:
        story = Story(bag, seed)
        story.write('/survey', room_points())
        story.learn(cases, practices)
        if task:
            story.touch('robot', 'wall_north', 1.5)
            story.push_to(goal)
    return story
