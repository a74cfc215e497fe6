"""Tables of an analysis, for CSV files and for the report."""

import csv
import math
import os
from dataclasses import dataclass
from typing import List, Tuple

import numpy as np

from casepush_analysis import metrics
from casepush_analysis.records import Part


@dataclass
class Column:
    """`key` heads the CSV column and names its unit; `heading` and `digits` are for people."""

    key: str
    heading: str
    digits: int = 0
    in_report: bool = True


@dataclass
class Table:
    name: str
    columns: List[Column]
    rows: List[Tuple]

    def shown(self):
        """Headings and rows as text, for people."""
        kept = [i for i, column in enumerate(self.columns) if column.in_report]
        return ([self.columns[i].heading for i in kept],
                [[for_people(row[i], self.columns[i].digits) for i in kept] for row in self.rows])

    def write(self, folder):
        with open(os.path.join(folder, self.name + '.csv'), 'w', newline='',
                  encoding='utf-8') as stream:
            writer = csv.writer(stream, lineterminator='\n')
            writer.writerow([column.key for column in self.columns])
            writer.writerows([[for_machines(value) for value in row] for row in self.rows])


def for_machines(value):
    if value is None:
        return ''
    if isinstance(value, bool):
        return 'true' if value else 'false'
    return f'{value:.9g}' if isinstance(value, float) else str(value)


def for_people(value, digits):
    if value is None:
        return '–'
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    if not isinstance(value, float):
        return str(value)
    if value and abs(value) < 0.5 * 10.0**-digits:
        return f'{value:.0e}'
    return f'{value:.{digits}f}'


def verdict(push):
    """One word on a push's prediction."""
    if not push.done:
        return push.outcome.replace('_', ' ')
    if not push.tested:
        return 'first try'
    return 'rejected' if push.rejected else 'as expected'


_PUSH_COLUMNS = [
    Column('number', '#'), Column('part', 'part', in_report=False),
    Column('plan', 'plan'), Column('push_in_plan', 'push'),
    Column('object', 'object', in_report=False), Column('case', 'case'),
    Column('outcome', 'outcome', in_report=False), Column('verdict', 'verdict'),
    Column('deviation_m', 'off by [m]', 3), Column('deviation_yaw_deg', 'off by [°]', 1),
    Column('t_squared', 'T²', 2), Column('p_value', 'p-value', 3),
    Column('start_x_m', '', 3, False), Column('start_y_m', '', 3, False),
    Column('start_yaw_deg', '', 1, False),
    Column('expected_x_m', 'expected x [m]', 3), Column('expected_y_m', 'y [m]', 3),
    Column('expected_yaw_deg', 'heading [°]', 1),
    Column('sigma_x_m', '± x [m]', 3), Column('sigma_y_m', '± y [m]', 3),
    Column('sigma_yaw_deg', '± heading [°]', 1),
    Column('cov_x_y_m2', '', 6, False), Column('cov_x_yaw_m_rad', '', 6, False),
    Column('cov_y_yaw_m_rad', '', 6, False),
    Column('observed_x_m', 'observed x [m]', 3), Column('observed_y_m', 'y [m]', 3),
    Column('observed_yaw_deg', 'heading [°]', 1),
    Column('start_s', 'start [s]', 1), Column('end_s', 'end [s]', 1, False),
    Column('plan_s', 'plan [s]', 1), Column('approach_s', 'approach [s]', 1),
    Column('push_s', 'push [s]', 1), Column('rest_s', 'rest [s]', 1),
    Column('explanation', '', in_report=False),
]


def pushes(analysis, part=None):
    """One row for each push, of one part or of all."""
    rows = []
    for number, (push, times) in enumerate(zip(analysis.recording.pushes, analysis.push_times), 1):
        if part in (None, push.part):
            rows.append(_push_row(number, push, times))
    return Table('pushes', _PUSH_COLUMNS, rows)


def _push_row(number, push, times):
    expected, deviation = push.map_expected, metrics.deviation(push)
    mean = expected.mean if expected else None
    covariance = expected.covariance if expected else np.zeros((3, 3))
    sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0)).tolist()

    def if_expected(*values):
        return values if expected else (None,) * len(values)

    return (number, push.part.value, push.plan_number or None, push.push_index or None,
            push.object_id, push.case_id or None, push.outcome, verdict(push),
            deviation.position_m if deviation else None,
            math.degrees(deviation.yaw_rad) if deviation else None,
            push.t_squared if push.tested else None, push.p_value if push.tested else None,
            push.map_start.x_m, push.map_start.y_m, math.degrees(push.map_start.yaw_rad),
            *((mean.x_m, mean.y_m, math.degrees(mean.yaw_rad)) if mean else (None,) * 3),
            *if_expected(sigma[0], sigma[1], math.degrees(sigma[2])),
            *if_expected(float(covariance[0, 1]), float(covariance[0, 2]),
                         float(covariance[1, 2])),
            push.map_end.x_m, push.map_end.y_m, math.degrees(push.map_end.yaw_rad),
            push.start_s, push.end_s, times.plan_s, times.approach_s, times.push_s, times.rest_s,
            push.explanation)


def plans(analysis):
    rows = [(entry.number, number, p.stamp_s, p.status, len(p.outcomes) or None,
             p.length_m if p.solved else None, p.nodes, p.planning_s, p.explanation)
            for entry in analysis.tasks for number, p in enumerate(entry.plans, 1)]
    return Table('plans', [
        Column('task', 'task'), Column('plan', 'plan'), Column('stamp_s', 'made at [s]', 1),
        Column('status', 'status'), Column('pushes', 'pushes'), Column('length_m', 'length [m]', 2),
        Column('nodes', 'nodes'), Column('planning_wall_s', 'planning (wall) [s]', 3),
        Column('explanation', 'explanation')], rows)


def tasks(analysis):
    rows = []
    for entry in analysis.tasks:
        error = entry.truth_error or entry.tracked_error
        causes = entry.replan_causes
        rows.append((
            entry.number, entry.task.object_id, entry.task.status, entry.success,
            len(entry.pushes), len(entry.plans) or None, entry.replans, entry.task.repairs,
            None if causes is None else ', '.join(
                f'{count} {cause.replace("_", " ")}' for cause, count in causes.items()),
            metrics.mean(entry.completed_runs),
            error.position_m if error else None,
            abs(math.degrees(error.yaw_rad)) if error else None,
            entry.end_s - entry.task.start_s))
    return Table('tasks', [
        Column('task', 'task'), Column('object', 'object'), Column('status', 'ended as'),
        Column('success', 'success'), Column('pushes', 'pushes'), Column('plans', 'plans'),
        Column('replans', 're-plans'), Column('repairs', 'repairs'),
        Column('replan_causes', 're-plans because of'),
        Column('mean_pushes_before_replan', 'pushes in a row', 1),
        Column('position_error_m', 'off by [m]', 3), Column('yaw_error_deg', 'off by [°]', 1),
        Column('duration_s', 'time [s]', 1)], rows)


def replans(analysis):
    rows = [(entry.number, number, replan.cause, replan.reason)
            for entry in analysis.tasks for number, replan in enumerate(entry.task.replans or [], 1)]
    return Table('replans', [Column('task', 'task'), Column('replan', 're-plan'),
                             Column('cause', 'cause'), Column('reason', 'in words')], rows)


def runs(analysis):
    rows = [(entry.number, run.plan_number, run.pushes, run.replanned)
            for entry in analysis.tasks for run in entry.runs]
    return Table('runs', [Column('task', 'task'), Column('plan', 'plan'),
                          Column('pushes', 'consecutive pushes'),
                          Column('ended_by_replan', 'ended by a re-plan')], rows)


def phases(analysis):
    rows = []
    for part in Part:
        totals = metrics.phase_totals(analysis.segments, part)
        whole = sum(totals.values())
        rows += [(part.value, name, total, 100.0 * total / whole) for name, total in totals.items()]
    return Table('phases', [Column('part', 'part'), Column('phase', 'phase'),
                            Column('total_s', 'time [s]', 1),
                            Column('share_percent', 'share [%]', 1)], rows)


def cases(analysis):
    rows = []
    for case in analysis.recording.cases:
        mean, sigma = case.outcome.mean, np.sqrt(np.maximum(np.diag(case.outcome.covariance), 0.0))
        rows.append((case.case_id, case.object, case.observation_count, case.effective_count,
                     mean.x_m, mean.y_m, math.degrees(mean.yaw_rad), float(sigma[0]),
                     float(sigma[1]), math.degrees(sigma[2])))
    return Table('cases', [
        Column('case', 'case'), Column('object', 'object'), Column('observations', 'pushes'),
        Column('effective_count', 'worth', 1), Column('mean_x_m', 'mean x [m]', 3),
        Column('mean_y_m', 'y [m]', 3), Column('mean_yaw_deg', 'heading [°]', 1),
        Column('sigma_x_m', '± x [m]', 3), Column('sigma_y_m', '± y [m]', 3),
        Column('sigma_yaw_deg', '± heading [°]', 1)], rows)


def collisions(analysis):
    rows = []
    for c in analysis.collisions or []:
        task = next((entry.number for entry in analysis.tasks
                     if metrics.within(c.start_s, entry.task)), None)
        rows.append((c.start_s, c.end_s - c.start_s, c.body, c.part, c.obstacle, c.impulse_ns,
                     task))
    return Table('collisions', [
        Column('start_s', 'at [s]', 2), Column('duration_s', 'for [s]', 2), Column('body', 'body'),
        Column('part', 'part'), Column('obstacle', 'touched'),
        Column('impulse_ns', 'impulse [N s]', 2), Column('task', 'task')], rows)


def all_tables(analysis):
    return [make(analysis) for make in (tasks, pushes, plans, replans, runs, phases, cases,
                                             collisions)]
