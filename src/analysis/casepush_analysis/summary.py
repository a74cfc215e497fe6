"""The figures of an analysis for programs: analysis.json."""

import json
import math
from dataclasses import asdict

from casepush_analysis import metrics
from casepush_analysis.records import Part


def summarise(analysis):
    """The last task on top, with the same keys as `casepush push --json`, then everything."""
    recording = analysis.recording
    last = _task(analysis.tasks[-1]) if analysis.tasks else {}
    headline = ('success', 'explanation', 'position_error_m', 'yaw_error_rad', 'pushes', 'replans',
                'plan_length_m', 'sim_time_s', 'collisions')
    return _rounded({
        **{key: last.get(key) for key in headline},
        'bag': recording.name,
        'duration_s': recording.end_s - recording.start_s,
        'tasks': [_task(entry) for entry in analysis.tasks],
        'learning': _learning(analysis),
        'cases': len(recording.cases),
        'calibration': {part.value: asdict(analysis.calibration[part]) for part in Part},
        'collisions_in_all': None if analysis.collisions is None else len(analysis.collisions),
        'missing': analysis.missing,
        'notes': recording.notes,
    })


def _task(entry):
    task, truth, tracked = entry.task, entry.truth_error, entry.tracked_error
    plans = entry.solved_plans
    deviations = [metrics.deviation(p).position_m for p in entry.pushes if p.tested]
    return {
        'object': task.object_id, 'success': entry.success, 'explanation': entry.explanation,
        'status': task.status,
        'goal': [task.map_goal.x_m, task.map_goal.y_m, math.degrees(task.map_goal.yaw_rad)],
        'position_error_m': truth.position_m if truth else None,
        'yaw_error_rad': abs(truth.yaw_rad) if truth else None,
        'tracked_position_error_m': tracked.position_m if tracked else None,
        'tracked_yaw_error_rad': abs(tracked.yaw_rad) if tracked else None,
        'tracking_rms_m': entry.tracking_rms_m,
        'pushes': len(entry.pushes), 'plans': len(entry.plans), 'replans': entry.replans,
        'repairs': task.repairs, 'replan_causes': entry.replan_causes,
        'replan_reasons': None if task.replans is None else [r.reason for r in task.replans],
        'rejected_predictions': sum(p.rejected for p in entry.pushes),
        'consecutive_pushes': [run.pushes for run in entry.runs],
        'mean_consecutive_pushes_before_replan': metrics.mean(entry.completed_runs),
        'median_consecutive_pushes_before_replan': metrics.median(entry.completed_runs),
        'mean_deviation_m': metrics.mean(deviations),
        'plan_length_m': plans[0].length_m if plans else None,
        'path_length_m': entry.path_length_m,
        'sim_time_s': entry.end_s - task.start_s,
        'collisions': None if entry.collisions is None else len(entry.collisions),
    }


def _learning(analysis):
    pushes = analysis.pushes(Part.LEARNING)
    runs = analysis.recording.learning
    return {
        'runs': [asdict(run) for run in runs],
        'pushes': len(pushes),
        'failed_pushes': sum(not p.done for p in pushes),
        'first_tries': sum(p.done and p.case_id == 0 for p in pushes),
        'phase_s': metrics.phase_totals(analysis.segments, Part.LEARNING),
    }


def _rounded(value):
    """Nine digits are plenty; what is not finite has no place in JSON."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(entry) for entry in value]
    if isinstance(value, float):
        return float(f'{value:.9g}') if math.isfinite(value) else None
    return value


def to_json(summary):
    return json.dumps(summary, indent=2, ensure_ascii=False, allow_nan=False) + '\n'
