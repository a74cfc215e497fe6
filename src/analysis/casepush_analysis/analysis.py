"""Everything that is computed about one recording, in one place for tables and report."""

from collections import Counter
from dataclasses import dataclass
from typing import Dict, List, Optional

from casepush_analysis import calibration, metrics, records
from casepush_analysis.records import Part


@dataclass
class TaskAnalysis:
    """One task: what was asked, done and achieved."""

    number: int  # From 1.
    task: records.TaskRecord
    end_s: float
    pushes: List[records.PushRecord]
    plans: List[records.PlanRecord]
    runs: List[metrics.Run]
    truth_error: Optional[metrics.FinalError]
    tracked_error: Optional[metrics.FinalError]
    tracking_rms_m: Optional[float]
    path_length_m: Optional[float]  # Of the object, by its poses at rest.
    calibration: calibration.Calibration
    collisions: Optional[List[metrics.Collision]]

    @property
    def solved_plans(self):
        return [p for p in self.plans if p.solved]

    @property
    def replans(self):
        """As the executor counted them, or as the pushes (repairs are plans, too) or plans tell."""
        if self.task.replans is not None:
            return len(self.task.replans)
        plans = max((p.plan_number for p in self.pushes), default=len(self.solved_plans))
        return max(0, plans - 1)

    @property
    def replan_causes(self):
        """How often each cause made a plan be given up; None if that was not recorded."""
        if self.task.replans is None:
            return None
        return dict(sorted(Counter(r.cause for r in self.task.replans).items()))

    @property
    def completed_runs(self):
        """Lengths of the runs that a re-plan ended."""
        return [run.pushes for run in self.runs if run.replanned]

    @property
    def success(self):
        """By ground truth; None if that was not recorded."""
        if self.truth_error is None:
            return None
        return self.truth_error.within_tolerance and self.task.status in ('succeeded', 'unknown')

    @property
    def explanation(self):
        if self.success is None:
            return f'{self.task.status}; the ground truth was not recorded'
        if self.success:
            return self.task.explanation or 'the object stands at its goal'
        if self.task.status == 'succeeded':
            return ('reported as a success, but by ground truth the object does not stand at its '
                    'goal')
        return self.task.explanation or self.task.status


@dataclass
class Analysis:
    """One recording with its numbers."""

    recording: records.Recording
    alpha: float
    segments: List[metrics.Segment]
    tasks: List[TaskAnalysis]
    push_times: List[metrics.PushTimes]  # Parallel to recording.pushes.
    calibration: Dict[Part, calibration.Calibration]
    collisions: Optional[List[metrics.Collision]]
    missing: List[str]

    def pushes(self, part):
        return [p for p in self.recording.pushes if p.part is part]

    def times(self, part):
        """PushTimes of the pushes of one part."""
        return [t for p, t in zip(self.recording.pushes, self.push_times) if p.part is part]


def analyse(recording):
    """All numbers of a recording."""
    segments = metrics.segments(recording.phases, recording.end_s)
    alpha = calibration.infer_alpha(recording.pushes)
    collisions = None
    if recording.contacts is not None:
        movable = set(recording.truth) | set(recording.tracked)
        movable |= {p.object_id for p in recording.pushes}
        collisions = metrics.collisions(recording.contacts, movable)
    by_part = {part: calibration.calibrate([p for p in recording.pushes if p.part is part], alpha)
               for part in Part}
    return Analysis(recording, alpha, segments,
                    [_task(n, t, recording, alpha, collisions)
                     for n, t in enumerate(recording.tasks, 1)],
                    metrics.push_times(recording.pushes, segments), by_part, collisions,
                    missing(recording))


def _task(number, task, recording, alpha, collisions):
    pushes = metrics.pushes_of(task, recording.pushes)
    plans = metrics.plans_of(task, recording.plans)
    truth, tracked = recording.truth.get(task.object_id), recording.tracked.get(task.object_id)
    end_s = recording.end_s if task.end_s is None else task.end_s
    last_plan_s = max((p.stamp_s for p in plans if p.solved), default=task.start_s)
    replanned = bool(pushes) and last_plan_s > pushes[-1].end_s  # ... but not pushed yet.
    return TaskAnalysis(
        number, task, end_s, pushes, plans, metrics.runs(pushes, replanned),
        metrics.final_error(task, truth), metrics.final_error(task, tracked),
        metrics.tracking_rms_m(tracked, truth, task.start_s, end_s) if truth and tracked else None,
        metrics.path_length_m([pushes[0].map_start] + [p.map_end for p in pushes])
        if pushes else None, calibration.calibrate(pushes, alpha),
        None if collisions is None else [c for c in collisions if metrics.within(c.start_s, task)])


def missing(recording):
    """What the bag does not hold, and what the report therefore cannot show."""
    has_task = bool(recording.tasks) or any(p.part is Part.TASK for p in recording.pushes)
    wanted = [
        (recording.pushes, 'push_reports', 'no push is known: no deviations, no verdicts'),
        (recording.cases, 'cases', 'the cases are not drawn'),
        (recording.phases, 'executor/state', 'times for planning and approach are unknown'),
        (recording.tracked, 'objects', 'the tracked path is not drawn'),
        (recording.truth, 'ground_truth/objects', 'success and final error are unknown'),
        (recording.contacts is not None, 'contacts', 'collisions are unknown'),
        (recording.robot.poses, 'tf', "the robot's path is not drawn"),
    ]
    if has_task:
        wanted += [
            (any(t.status != 'unknown' for t in recording.tasks), 'push_object/goal',
             'goal and times of the task are taken from the plans, its tolerance is assumed'),
            (recording.plans, 'plan', 'plans are not drawn, re-plans are counted from pushes'),
            (all(t.replans is not None for t in recording.tasks), 'task_summaries',
             'why plans were given up is unknown'),
            (recording.room is not None, 'survey', 'the room is not drawn'),
        ]
    return [f'{topic}: {consequence}' for present, topic, consequence in wanted if not present]
