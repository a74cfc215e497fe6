"""The HTML report: one file that needs nothing beside it."""

import base64
import math
import os

import jinja2

from casepush_analysis import metrics, tables
from casepush_analysis.records import Part

_FOLDER = os.path.dirname(os.path.abspath(__file__))


def render(analysis, pictures):
    """The report as a text. `pictures` maps names to PNG files."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(_FOLDER), autoescape=True,
                                     trim_blocks=True, lstrip_blocks=True,
                                     undefined=jinja2.StrictUndefined)
    environment.filters['fixed'] = tables.for_people
    environment.filters['duration'] = duration
    environment.filters['degrees'] = lambda angle: None if angle is None else math.degrees(angle)
    environment.filters['percent'] = lambda rate: None if rate is None else 100.0 * rate
    environment.filters['sentence'] = lambda text: text[:1].upper() + text[1:].rstrip('.') + '.'
    return environment.get_template('report.html.j2').render(
        analysis=analysis, recording=analysis.recording, metrics=metrics, tables=tables,
        pictures={name: _embed(path) for name, path in pictures.items()}, Part=Part,
        task_pushes=lambda entry: _task_pushes(analysis, entry),
        learning_phases=metrics.phase_totals(analysis.segments, Part.LEARNING))


def duration(seconds):
    """Seconds for people: 75.2 s, 12 min 31 s, 1 h 02 min."""
    if seconds is None:
        return '–'
    if seconds < 120.0:
        return f'{seconds:.1f} s'
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 120:
        return f'{minutes} min {rest:02d} s'
    return f'{minutes // 60} h {minutes % 60:02d} min'


def _task_pushes(analysis, entry):
    """The table of one task's pushes, numbered as in its pictures."""
    whole = tables.pushes(analysis, Part.TASK)
    wanted = {id(p): number for number, p in enumerate(entry.pushes, 1)}
    rows = [(wanted[id(push)],) + row[1:]
            for push, row in zip(analysis.pushes(Part.TASK), whole.rows) if id(push) in wanted]
    return tables.Table('pushes', whole.columns, rows)


def _embed(path):
    with open(path, 'rb') as stream:
        return 'data:image/png;base64,' + base64.b64encode(stream.read()).decode('ascii')
