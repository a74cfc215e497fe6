"""What a case base holds, as `casepush cases dump` prints it."""

import json
import subprocess
from dataclasses import dataclass, field
from typing import List, Optional

import numpy as np

from casepush_analysis.errors import InputError
from casepush_analysis.records import CaseRecord
from casepush_analysis.se2 import Pose2, PoseGaussian


@dataclass
class Observation:
    """One push of a case, in the frame of the object before it."""

    source: str  # "explored", "demonstrated", "practised", "adapted" or "transferred".
    outcome: Pose2
    path: List[Pose2]  # Empty if only the outcome is known.
    p_value: Optional[float] = None  # Predicted from the case's other observations.
    plug_in_p_value: Optional[float] = None


@dataclass
class StoredCase:
    """A case with all that was observed of it."""

    record: CaseRecord
    load_kg: Optional[float]
    noticed: int
    tube: List[PoseGaussian]
    observations: List[Observation] = field(default_factory=list)


def read_case_base(path, object_name=''):
    """The cases of a file, of one object if it is named, ascending by id."""
    command = ['rosrun', 'casepush', 'casepush', 'cases', 'dump', '--case-base', path, '--json']
    if object_name:
        command += ['--object', object_name]
    process = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                             check=False)
    if process.returncode != 0:
        lines = process.stderr.strip().splitlines() or ['casepush could not be run']
        raise InputError(lines[-1].replace('casepush: error: ', ''))
    return [_case(entry) for entry in json.loads(process.stdout)['cases']]


def _pose(numbers):
    return Pose2(*numbers)


def _gaussian(entry):
    return PoseGaussian(_pose(entry['mean']), np.array(entry['covariance']).reshape(3, 3))


def _observation(entry):
    left_out = entry.get('left_out', {})
    return Observation(entry['source'], _pose(entry['start_T_object']),
                       [_pose(p) for p in entry['path']], left_out.get('p_value'),
                       left_out.get('plug_in_p_value'))


def _case(entry):
    record = CaseRecord(entry['id'], entry['object'], [_pose(p) for p in entry['robot_path']],
                        [_pose(p) for p in entry['object_path']], _gaussian(entry['outcome']),
                        entry['effective_count'], entry['observations'], entry['push_steps'])
    return StoredCase(record, entry.get('load_kg'), entry.get('noticed', 0),
                      [_gaussian(g) for g in entry['tube']],
                      [_observation(o) for o in entry['history']])
