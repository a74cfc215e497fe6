"""Plain records: what a recording says, free of ROS. Poses are in the map frame unless named
otherwise; times are seconds of the recording's own (usually simulated) clock."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Dict, List, Optional, Tuple

import numpy as np

from casepush_analysis.se2 import Pose2, PoseGaussian


class Part(Enum):
    """What a push belongs to."""

    LEARNING = 'learning'
    TASK = 'task'


@dataclass
class PushRecord:
    """One executed push."""

    object_id: str
    case_id: int  # 0: tried for the first time, nothing was predicted.
    outcome: str  # "done" or why not.
    explanation: str
    start_s: float  # The push proper began.
    end_s: float  # The object had come to rest.
    map_start: Pose2
    map_end: Pose2
    map_expected: Optional[PoseGaussian]
    t_squared: float
    p_value: float
    rejected: bool
    push_s: float  # Of the time from start_s to end_s, how long the robot pushed.
    plan_number: int = 0  # Of its task, from 1; 0: belongs to no plan.
    push_index: int = 0  # In that plan, from 1.
    map_path: List[Pose2] = field(default_factory=list)

    @property
    def part(self):
        return Part.TASK if self.plan_number > 0 else Part.LEARNING

    @property
    def done(self):
        return self.outcome == 'done'

    @property
    def tested(self):
        return self.done and self.map_expected is not None

    @property
    def rest_s(self):
        return max(0.0, self.end_s - self.start_s - self.push_s)


@dataclass
class PlanRecord:
    """One plan, solved or not."""

    stamp_s: float
    object_id: str
    status: str
    explanation: str
    map_start: Pose2
    map_goal: Pose2
    outcomes: List[PoseGaussian]  # Where each push should end.
    case_ids: List[int]
    length_m: float
    nodes: Optional[int] = None
    planning_s: Optional[float] = None  # Wall time of the planner.

    @property
    def solved(self):
        return self.status == 'solved'


@dataclass
class CaseRecord:
    """One probabilistic case, in the frame of the object's pose before the push."""

    case_id: int
    object: str
    robot_path: List[Pose2]
    object_path: List[Pose2]
    outcome: PoseGaussian
    effective_count: float
    observation_count: int
    push_steps: int = 0  # The robot pushes during this many samples.


@dataclass
class Track:
    """Poses of one object over time."""

    times_s: List[float] = field(default_factory=list)
    poses: List[Pose2] = field(default_factory=list)


@dataclass
class PhaseSample:
    """What the executor was doing from this stamp on."""

    stamp_s: float
    phase: str  # "planning", "approach", "dock", "push", "rest"; "idle" between goals.
    part: Optional[Part] = None  # None while idle.


@dataclass
class ContactRecord:
    """One report of two bodies touching."""

    stamp_s: float
    body_a: str
    part_a: str
    body_b: str
    part_b: str
    impulse_ns: float


@dataclass
class TaskRecord:
    """One request to bring an object to a goal."""

    object_id: str
    map_goal: Pose2
    position_tolerance_m: float
    yaw_tolerance_rad: float
    start_s: float
    end_s: Optional[float] = None  # None: the recording ends first.
    status: str = 'unfinished'
    explanation: str = ''
    replans: Optional[List['ReplanRecord']] = None  # None: the task's summary is not recorded.
    repairs: Optional[int] = None  # Plans kept but for what followed the next push.
    clearing_pushes: int = 0  # To bring other objects out of the way.


@dataclass
class ReplanRecord:
    """Why one plan was given up."""

    cause: str  # "prediction_rejected", "left_tube", ...
    reason: str  # In words.


@dataclass
class LearningRecord:
    """One run of the learner."""

    object_id: str
    start_s: float
    end_s: Optional[float] = None
    status: str = 'unfinished'
    explanation: str = ''
    cases: Optional[int] = None
    pushes: Optional[int] = None
    discarded: Optional[int] = None
    dropped: Optional[int] = None


@dataclass
class RoomMap:
    """The room from above: the highest occupied point of each square cell."""

    min_x_m: float
    min_y_m: float
    cell_m: float
    height_m: np.ndarray  # Rows along y, columns along x; NaN where nothing stands.

    @property
    def extent_m(self):
        """Left, right, bottom, top."""
        rows, columns = self.height_m.shape
        return (self.min_x_m, self.min_x_m + columns * self.cell_m,
                self.min_y_m, self.min_y_m + rows * self.cell_m)


@dataclass
class Recording:
    """Everything that was understood of one bag."""

    name: str
    start_s: float = 0.0
    end_s: float = 0.0
    message_count: int = 0
    notes: List[str] = field(default_factory=list)  # Damage, what is missing: for the reader.
    topics: Dict[str, Tuple[str, int]] = field(default_factory=dict)  # name: (type, messages)
    pushes: List[PushRecord] = field(default_factory=list)
    plans: List[PlanRecord] = field(default_factory=list)
    cases: List[CaseRecord] = field(default_factory=list)
    tasks: List[TaskRecord] = field(default_factory=list)
    learning: List[LearningRecord] = field(default_factory=list)
    tracked: Dict[str, Track] = field(default_factory=dict)
    truth: Dict[str, Track] = field(default_factory=dict)
    robot: Track = field(default_factory=Track)
    phases: List[PhaseSample] = field(default_factory=list)
    contacts: Optional[List[ContactRecord]] = None  # None: contacts were not recorded.
    room: Optional[RoomMap] = None
