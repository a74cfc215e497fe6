"""Which figures an analysis calls for, and their files."""

import os

from casepush_analysis.calibration import tested_pushes
from casepush_analysis.figures import (calibration, cases, deviations, room_map, style, timeline)
from casepush_analysis.records import Part


def draw_all(analysis, folder):
    """Draws every figure that there is data for. Returns {name: file}, in the order of drawing."""
    files = {}

    def save(name, figure):
        files[name] = os.path.join(folder, name + '.png')
        style.save(figure, files[name])

    with style.look():
        for entry in analysis.tasks:
            _draw_task(analysis, entry, save)
        if analysis.recording.cases:
            save('cases', cases.draw(analysis.recording.cases))
        _draw_learning(analysis, save)
    return files


def _draw_task(analysis, entry, save):
    task, recording = entry.task, analysis.recording
    name = f'task_{entry.number}'
    save(f'{name}_map', room_map.draw(recording, entry, True))
    if recording.room is not None:
        save(f'{name}_way', room_map.draw(recording, entry, False))
    if any(p.tested for p in entry.pushes):
        save(f'{name}_deviations', deviations.draw(entry.pushes, analysis.alpha,
                                                   'Task: deviation from the prediction'))
    if tested_pushes(entry.pushes):
        save(f'{name}_calibration', calibration.draw(entry.pushes, analysis.alpha,
                                                     'Task: p-values of the predictions'))
    segments = [s for s in analysis.segments
                if s.part is Part.TASK and task.start_s <= s.end_s and s.start_s <= entry.end_s]
    if segments:
        save(f'{name}_timeline', timeline.draw(segments, entry.pushes, task.start_s,
                                               'Task: what the robot did'))


def _draw_learning(analysis, save):
    pushes = analysis.pushes(Part.LEARNING)
    if any(p.tested for p in pushes):
        save('learning_deviations', deviations.draw(pushes, analysis.alpha,
                                                    'Learning: deviation from the prediction'))
    if tested_pushes(pushes):
        save('learning_calibration', calibration.draw(pushes, analysis.alpha,
                                                      'Learning: p-values of the predictions'))
    segments = [s for s in analysis.segments if s.part is Part.LEARNING]
    if segments:
        save('learning_timeline', timeline.draw(segments, pushes, segments[0].start_s,
                                                'Learning: what the robot did'))
