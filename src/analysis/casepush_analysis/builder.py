"""Puts the messages of a bag together into a Recording, topic by topic."""

import struct

import genmsg
import genpy

from casepush_analysis import conversions, records, room
from casepush_analysis.conversions import NotFinite
from casepush_analysis.se2 import Pose2

TRACK_PERIOD_S = 0.1
TF_BURST_S = 0.05  # map->odom and odom->base_link come in messages of their own.


class Thinner:
    """Lets a burst of messages through once per period: tracks need no more."""

    def __init__(self, period_s, burst_s=0.0):
        self._period_s = period_s
        self._burst_s = burst_s
        self._next_s = None

    def passes(self, stamp_s):
        if (self._next_s is None or stamp_s >= self._next_s + self._period_s
                or stamp_s < self._next_s):
            self._next_s = stamp_s
            return True
        return stamp_s <= self._next_s + self._burst_s


class Builder:
    """Feed it messages in the order of time, then call finish()."""

    def __init__(self, name):
        self.recording = records.Recording(name=name)
        self._tasks = {}
        self._learning = {}
        self._frames = {}
        self._planned = []  # From topic plan; used if results of plan_push are missing.
        self._skipped = {}
        self._handlers = {
            ('ExecutedPush', ''): self._push,
            ('Plan', ''): self._plan,
            ('PlanPushActionResult', ''): self._plan_result,
            ('PushObjectActionGoal', ''): self._task_goal,
            ('PushObjectActionResult', ''): self._task_result,
            ('TaskSummary', ''): self._task_summary,
            ('LearnObjectActionGoal', ''): self._learn_goal,
            ('LearnObjectActionResult', ''): self._learn_result,
            ('PushCaseArray', ''): self._cases,
            ('ExecutorState', ''): self._state,
            ('BodyContactArray', ''): self._contacts,
            ('PushableObjectArray', 'ground_truth/objects'): self._truth,
            ('PushableObjectArray', 'objects'): self._tracked,
            ('Octomap', ''): self._octomap,
            ('PointCloud2', 'survey'): self._survey,
            ('TFMessage', 'tf'): self._tf,
            ('TFMessage', 'tf_static'): self._tf,
        }

    def handler(self, topic, datatype):
        """What to call with (message, stamp_s), or None if the topic is of no interest here."""
        kind = datatype.rpartition('/')[2]
        for (wanted, suffix), function in self._handlers.items():
            if kind == wanted and ('/' + topic).endswith('/' + suffix if suffix else ''):
                return function
        return None

    @staticmethod
    def thinner(datatype):
        """Thins out a topic before it is even decoded; None keeps every message."""
        if datatype.endswith('/PushableObjectArray'):
            return Thinner(TRACK_PERIOD_S)
        if datatype.endswith('/TFMessage'):
            return Thinner(TRACK_PERIOD_S, TF_BURST_S)
        return None

    @staticmethod
    def newest_counts(datatype):
        """True if only the newest message of a topic matters, so that the others stay undecoded."""
        return datatype.endswith(('/PushCaseArray', '/Octomap'))

    def add(self, topic, function, decode, stamp_s):
        """Hands one message on; one that makes no sense is counted and left out."""
        try:
            function(decode(), stamp_s)
        except NotFinite:
            self._skip(topic, 'with numbers that are not finite')
        except (AttributeError, IndexError, KeyError, TypeError, ValueError, struct.error,
                genpy.DeserializationError, genmsg.MsgGenerationException, genmsg.InvalidMsgSpec):
            self._skip(topic, 'that this version does not understand')

    def _skip(self, topic, why):
        self._skipped[(topic, why)] = self._skipped.get((topic, why), 0) + 1

    def finish(self):
        recording = self.recording
        if not recording.plans:
            recording.plans = self._planned
        recording.tasks = list(self._tasks.values()) or tasks_from_plans(recording)
        recording.learning = list(self._learning.values())
        for (topic, why), count in sorted(self._skipped.items()):
            recording.notes.append(f'{topic}: {count} message{"s" * (count > 1)} {why}, left out.')
        return recording

    def _push(self, message, _):
        self.recording.pushes.append(conversions.push(message))

    def _plan(self, message, stamp_s):
        self._planned.append(conversions.plan(message, stamp_s))

    def _plan_result(self, message, stamp_s):
        self.recording.plans.append(conversions.plan_result(message.result, stamp_s))

    def _task_goal(self, message, stamp_s):
        self._tasks[message.goal_id.id] = conversions.task(message.goal, stamp_s)

    def _task_result(self, message, stamp_s):
        _close(self._tasks.get(message.status.goal_id.id), message.result, stamp_s)

    def _task_summary(self, message, stamp_s):
        record = self._tasks.setdefault(message.goal_id, conversions.task_from_summary(message))
        record.end_s, record.status, record.explanation = (stamp_s, message.status,
                                                           message.explanation)
        record.replans = conversions.replans(message)
        record.clearing_pushes = message.clearing_pushes
        record.repairs = message.repairs

    def _learn_goal(self, message, stamp_s):
        self._learning[message.goal_id.id] = records.LearningRecord(message.goal.object_id, stamp_s)

    def _learn_result(self, message, stamp_s):
        result = message.result
        run = self._learning.setdefault(message.status.goal_id.id, records.LearningRecord(
            '', stamp_s - conversions.finite(result.duration)))
        run.cases, run.pushes = result.cases, result.pushes
        run.discarded, run.dropped = result.discarded, result.dropped
        _close(run, result, stamp_s)

    def _cases(self, message, _):
        self.recording.cases = [conversions.case(c) for c in message.cases if c.steps]

    def _state(self, message, stamp_s):
        sample = conversions.phase(message, stamp_s)
        phases = self.recording.phases
        if not phases or (phases[-1].phase, phases[-1].part) != (sample.phase, sample.part):
            phases.append(sample)

    def _contacts(self, message, stamp_s):
        if self.recording.contacts is None:
            self.recording.contacts = []
        self.recording.contacts.extend(conversions.contact(c, stamp_s) for c in message.contacts)

    def _truth(self, message, stamp_s):
        _track(self.recording.truth, message, stamp_s)

    def _tracked(self, message, stamp_s):
        _track(self.recording.tracked, message, stamp_s)

    def _octomap(self, message, _):
        self.recording.room = room.from_octomap(message) or self.recording.room

    def _survey(self, message, _):
        self.recording.room = self.recording.room or room.from_points(message)

    def _tf(self, message, stamp_s):
        for transform in message.transforms:
            child = transform.child_frame_id.lstrip('/')
            self._frames[child] = (transform.header.frame_id.lstrip('/'), conversions.planar(
                transform.transform.translation, transform.transform.rotation))
        pose = self._map_robot()
        track = self.recording.robot
        if pose and (not track.times_s or stamp_s - track.times_s[-1] >= TRACK_PERIOD_S):
            track.times_s.append(stamp_s)
            track.poses.append(pose)

    def _map_robot(self):
        frame, pose, steps = 'base_link', Pose2(), 0
        while frame != 'map':
            if frame not in self._frames or steps > 10:
                return None
            parent, parent_pose = self._frames[frame]
            frame, pose, steps = parent, parent_pose @ pose, steps + 1
        return pose


def _close(record, result, stamp_s):
    if record is not None:
        record.end_s = stamp_s
        record.status = conversions.constant_name(result, result.status)
        record.explanation = result.explanation


def _track(tracks, message, stamp_s):
    for body in message.objects:
        track = tracks.setdefault(body.id, records.Track())
        if not track.times_s or stamp_s > track.times_s[-1]:
            pose = conversions.planar(body.pose.pose.position, body.pose.pose.orientation)
            track.times_s.append(stamp_s)
            track.poses.append(pose)


def tasks_from_plans(recording):
    """Tasks as far as plans and pushes tell, for a bag without the action push_object."""
    tasks = []
    for plan in (p for p in recording.plans if p.solved):
        if not tasks or tasks[-1].map_goal != plan.map_goal:
            tasks.append(records.TaskRecord(
                plan.object_id, plan.map_goal, conversions.DEFAULT_POSITION_TOLERANCE_M,
                conversions.DEFAULT_YAW_TOLERANCE_RAD, plan.stamp_s, status='unknown'))
    for task, following in zip(tasks, tasks[1:]):
        task.end_s = following.start_s
    return tasks
