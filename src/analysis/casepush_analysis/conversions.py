"""ROS messages to plain records. Works on any object with the fields of the package's messages."""

import math

import numpy as np

from casepush_analysis import records
from casepush_analysis.se2 import Pose2, PoseGaussian

DEFAULT_POSITION_TOLERANCE_M = 0.2  # What a goal of 0 means: action/PushObject.action.
DEFAULT_YAW_TOLERANCE_RAD = math.pi / 9.0


class NotFinite(ValueError):
    """A message carries a number that is not finite."""


def constant_name(message, value):
    """Name of the constant of the message's type that has this value, in lower case."""
    for name in sorted(dir(type(message))):
        if name.isupper() and not name.startswith('_') and getattr(message, name) == value:
            return name.lower()
    return f'unknown ({value})'


def finite(value):
    if not math.isfinite(value):
        raise NotFinite()
    return value


def pose2d(message):
    """geometry_msgs/Pose2D."""
    return Pose2(finite(message.x), finite(message.y), finite(message.theta))


def planar(position, rotation):
    """Pose or Transform projected to the floor: position and quaternion."""
    norm = rotation.x**2 + rotation.y**2 + rotation.z**2 + rotation.w**2
    if not norm > 0.0:
        raise NotFinite()
    yaw = math.atan2(2.0 * (rotation.w * rotation.z + rotation.x * rotation.y),
                     norm - 2.0 * (rotation.y**2 + rotation.z**2))
    return Pose2(finite(position.x), finite(position.y), finite(yaw))


def gaussian(message):
    covariance = np.array(message.covariance, dtype=float).reshape(3, 3)
    if not np.all(np.isfinite(covariance)):
        raise NotFinite()
    return PoseGaussian(pose2d(message.mean), covariance)


def push(message):
    """casepush/ExecutedPush."""
    start = pose2d(message.start)
    done = message.outcome == message.DONE
    recorded = message.recorded
    return records.PushRecord(
        object_id=message.object_id, case_id=message.case_id,
        outcome=constant_name(message, message.outcome), explanation=message.explanation,
        start_s=message.start_stamp.to_sec(), end_s=message.end_stamp.to_sec(),
        map_start=start, map_end=pose2d(message.observed),
        map_expected=gaussian(message.expected) if message.case_id > 0 and done else None,
        t_squared=finite(message.t_squared), p_value=finite(message.p_value),
        rejected=bool(message.rejected), push_s=finite(recorded.period) * recorded.push_steps,
        plan_number=message.plan_number, push_index=message.push_index,
        map_path=[start @ pose2d(step.start_T_object) for step in recorded.steps])


def plan(message, stamp_s):
    """casepush/Plan."""
    return records.PlanRecord(
        stamp_s=stamp_s, object_id=message.object.id, status='solved', explanation='',
        map_start=pose2d(message.object.pose), map_goal=pose2d(message.goal),
        outcomes=[gaussian(p.outcome) for p in message.pushes],
        case_ids=[p.case_id for p in message.pushes], length_m=finite(message.length))


def plan_result(message, stamp_s):
    """casepush/PlanPushResult; failed plans have neither start nor pushes."""
    if message.status == message.SOLVED:
        record = plan(message.plan, stamp_s)
    else:
        record = records.PlanRecord(stamp_s=stamp_s, object_id='', status='', explanation='',
                                    map_start=None, map_goal=None, outcomes=[], case_ids=[],
                                    length_m=0.0)
    record.status = constant_name(message, message.status)
    record.explanation = message.explanation
    record.nodes = message.nodes
    record.planning_s = finite(message.planning_time)
    return record


def case(message):
    """casepush/PushCase."""
    object_path = [pose2d(step.start_T_object) for step in message.steps]
    return records.CaseRecord(
        case_id=message.id, object=message.object,
        robot_path=[o @ pose2d(step.object_T_robot)
                    for o, step in zip(object_path, message.steps)],
        object_path=object_path, outcome=gaussian(message.outcome),
        effective_count=finite(message.effective_count),
        observation_count=message.observation_count, push_steps=message.push_steps)


def task(goal, stamp_s):
    """casepush/PushObjectGoal; 0 stands for the default tolerance."""
    return records.TaskRecord(
        object_id=goal.object_id, map_goal=planar(goal.goal.pose.position,
                                                  goal.goal.pose.orientation),
        position_tolerance_m=goal.position_tolerance or DEFAULT_POSITION_TOLERANCE_M,
        yaw_tolerance_rad=goal.yaw_tolerance or DEFAULT_YAW_TOLERANCE_RAD, start_s=stamp_s)


def task_from_summary(summary):
    """casepush/TaskSummary; it knows nothing of the time before it began."""
    return records.TaskRecord(
        object_id=summary.object_id, map_goal=pose2d(summary.goal),
        position_tolerance_m=finite(summary.position_tolerance),
        yaw_tolerance_rad=finite(summary.yaw_tolerance), start_s=summary.start_stamp.to_sec())


def replans(summary):
    """casepush/TaskSummary."""
    return [records.ReplanRecord(cause, reason)
            for cause, reason in zip(summary.replan_causes, summary.replan_reasons)]


def phase(message, stamp_s):
    """casepush/ExecutorState."""
    if message.activity == message.IDLE:
        return records.PhaseSample(stamp_s, 'idle')
    part = (records.Part.TASK if message.activity == message.PUSHING_OBJECT
            else records.Part.LEARNING)
    return records.PhaseSample(stamp_s, message.phase or 'idle', part)


def contact(message, stamp_s):
    """casepush/BodyContact."""
    return records.ContactRecord(stamp_s, message.body_a, message.part_a, message.body_b,
                                 message.part_b, finite(message.impulse))
