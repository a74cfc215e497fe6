"""Numbers of a recording: pure functions over plain records."""

import math
from dataclasses import dataclass
from typing import List, Optional

from casepush_analysis.records import Part
from casepush_analysis.se2 import interpolate

CONTACT_GAP_S = 0.1  # A pause longer than this starts a new collision.
FLOOR_NAMES = ('floor', 'ground')


@dataclass
class Segment:
    """A stretch of time in one phase."""

    start_s: float
    end_s: float
    phase: str
    part: Optional[Part]

    @property
    def duration_s(self):
        return self.end_s - self.start_s


@dataclass
class Deviation:
    """How far a push ended from where its case said."""

    position_m: float
    yaw_rad: float  # Observed minus expected.


@dataclass
class PushTimes:
    """Where the time of one push went [s]; None: the executor's state was not recorded."""

    plan_s: Optional[float]
    approach_s: Optional[float]
    push_s: float
    rest_s: float


@dataclass
class Run:
    """Pushes executed in a row from one plan."""

    plan_number: int
    pushes: int
    replanned: bool  # False: the run ended with the task.


@dataclass
class Collision:
    """An uninterrupted contact that should not have been."""

    start_s: float
    end_s: float
    body: str  # The body that moves, and the link of it that touched first.
    part: str
    obstacle: str
    impulse_ns: float


@dataclass
class FinalError:
    """Where the object stood when its task ended, against the goal."""

    position_m: float
    yaw_rad: float
    within_tolerance: bool


def deviation(push):
    """None if nothing was predicted or the push was not completed."""
    if not push.tested:
        return None
    mean = push.map_expected.mean
    return Deviation(mean.distance_m(push.map_end), mean.yaw_difference_rad(push.map_end))


def segments(phases, end_s):
    """Stretches between changes of phase; the last one lasts until `end_s`."""
    ends = [p.stamp_s for p in phases[1:]] + [end_s]
    return [Segment(p.stamp_s, end, p.phase, p.part)
            for p, end in zip(phases, ends) if end > p.stamp_s]


def time_in(parts, names, start_s, end_s):
    """Time [s] that segments of the named phases spend between two instants."""
    return sum(max(0.0, min(s.end_s, end_s) - max(s.start_s, start_s))
               for s in parts if s.phase in names)


def phase_totals(parts, part):
    """Time [s] in each phase of one part of the recording, in the order of first appearance."""
    totals = {}
    for segment in parts:
        if segment.part is part:
            totals[segment.phase] = totals.get(segment.phase, 0.0) + segment.duration_s
    return totals


def push_times(pushes, parts):
    """One PushTimes for each push; what precedes a push since the one before counts as its own."""
    times = []
    previous_end = -math.inf
    for push in pushes:
        known = bool(parts)
        times.append(PushTimes(
            time_in(parts, ('planning',), previous_end, push.start_s) if known else None,
            time_in(parts, ('approach', 'dock'), previous_end, push.start_s) if known else None,
            push.push_s if push.done else max(0.0, push.end_s - push.start_s),
            push.rest_s if push.done else 0.0))
        previous_end = push.end_s
    return times


def pushes_of(task, pushes):
    """Pushes that a task executed."""
    end_s = math.inf if task.end_s is None else task.end_s
    return [p for p in pushes if p.part is Part.TASK and p.object_id == task.object_id
            and task.start_s <= p.end_s <= end_s + 1e-3]


def plans_of(task, plans):
    """Plans, solved or not, that were made for a task."""
    end_s = math.inf if task.end_s is None else task.end_s
    return [p for p in plans if task.start_s <= p.stamp_s <= end_s + 1e-3
            and p.object_id in ('', task.object_id)]


def runs(pushes, ended_by_replan=False):
    """Runs of completed pushes between re-plans, of one task's pushes in order.

    `ended_by_replan` says that the last run, too, was followed by another plan.
    """
    found: List[Run] = []
    for push in pushes:
        if not found or found[-1].plan_number != push.plan_number:
            found.append(Run(push.plan_number, 0, False))
        found[-1].pushes += push.done
    for run in found[:-1]:
        run.replanned = True
    if found and ended_by_replan:
        found[-1].replanned = True
    return found


def is_floor(name):
    return name.lower().startswith(FLOOR_NAMES)


def collisions(contacts, movable):
    """Contacts of the robot or an object with anything that never moves, joined over time.

    `movable` names the objects; every other body but the robot is part of the building.
    """
    moving = set(movable) | {'robot'}
    open_ones, closed = {}, []
    for contact in sorted(contacts, key=lambda c: c.stamp_s):
        a_moves, b_moves = contact.body_a in moving, contact.body_b in moving
        if a_moves == b_moves or is_floor(contact.body_a) or is_floor(contact.body_b):
            continue
        body, part, obstacle = ((contact.body_a, contact.part_a, contact.body_b) if a_moves
                                else (contact.body_b, contact.part_b, contact.body_a))
        key = (body, obstacle)
        current = open_ones.get(key)
        if current is None or contact.stamp_s - current.end_s > CONTACT_GAP_S:
            current = Collision(contact.stamp_s, contact.stamp_s, body, part, obstacle, 0.0)
            open_ones[key] = current
            closed.append(current)
        current.end_s = contact.stamp_s
        current.impulse_ns += contact.impulse_ns
    return closed


def within(time_s, task):
    return task.start_s <= time_s <= (math.inf if task.end_s is None else task.end_s)


def final_error(task, track):
    """Error at the end of a task by the given track; None without samples in the task's time."""
    if track is None:
        return None
    poses = [p for t, p in zip(track.times_s, track.poses) if within(t, task)]
    if not poses:
        return None
    position = task.map_goal.distance_m(poses[-1])
    yaw = task.map_goal.yaw_difference_rad(poses[-1])
    return FinalError(position, yaw, position <= task.position_tolerance_m
                      and abs(yaw) <= task.yaw_tolerance_rad)


def tracking_rms_m(tracked, truth, start_s, end_s):
    """RMS distance [m] between where an object was believed and where it was; None if unknown."""
    squares = []
    for time, pose in zip(tracked.times_s, tracked.poses):
        actual = interpolate(truth.times_s, truth.poses, time) if start_s <= time <= end_s else None
        if actual is not None:
            distance_m = pose.distance_m(actual)
            squares.append(distance_m * distance_m)
    return math.sqrt(sum(squares) / len(squares)) if squares else None


def path_length_m(poses):
    """Length of a chain of poses [m]."""
    return sum(a.distance_m(b) for a, b in zip(poses, poses[1:]))


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else None


def median(values):
    ordered = sorted(values)
    if not ordered:
        return None
    middle = len(ordered) // 2
    return ordered[middle] if len(ordered) % 2 else (ordered[middle - 1] + ordered[middle]) / 2.0
