"""What was observed of each case: outcomes with their ellipse, trajectories with their tube."""

import math

import numpy as np
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from casepush_analysis.figures import geometry, style

_LEAST_SPAN_M = 0.1
_SOURCES = {'explored': ('s', style.TRUTH), 'demonstrated': ('D', style.GOAL),
            'practised': ('o', '#4a7fb5'), 'adapted': ('^', style.OBSERVED),
            'transferred': ('v', style.NEUTRAL)}


def draw(stored):
    """One small plot for each case, on one scale: where the object came to rest."""
    figure, panels = _panels(stored)
    span = max([_LEAST_SPAN_M] + [_span(c) for c in stored])
    for axes, case in zip(panels, stored):
        _draw_outcomes(axes, case, span)
    used = {o.source for c in stored for o in c.observations}
    handles = [Line2D([], [], linestyle='', marker=marker, color=colour, markersize=5, label=name)
               for name, (marker, colour) in _SOURCES.items() if name in used]
    handles.append(Patch(facecolor=style.EXPECTED, edgecolor='#b8860b', alpha=0.5,
                         label='95 % of the case\'s Gaussian'))
    _finish(figure, stored, 'observed resting poses', handles)
    return figure


def draw_tubes(stored):
    """One small plot for each case: trajectories of all practices, their mean and its spread."""
    figure, panels = _panels(stored)
    for axes, case in zip(panels, stored):
        _draw_tube(axes, case)
    _finish(figure, stored, 'object trajectories of all practices', [
        Line2D([], [], color='#8fb3d9', linewidth=1.0, label='observed'),
        Line2D([], [], color=style.OBSERVED, linewidth=1.8, label='mean (aligned by DTW)'),
        Patch(facecolor=style.EXPECTED, edgecolor='#b8860b', alpha=0.4,
              label='95 % along the way')])
    return figure


def _panels(stored):
    columns = min(5, max(1, math.ceil(math.sqrt(len(stored)))))
    rows = math.ceil(len(stored) / columns)
    figure = style.new_figure(max(6.5, 2.5 * columns), 2.6 * rows + 0.9)
    figure.set_constrained_layout_pads(w_pad=0.06, h_pad=0.08)
    panels = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axes in panels[len(stored):]:
        axes.set_visible(False)
    return figure, panels[:len(stored)]


def _finish(figure, stored, what, handles):
    figure.suptitle(f'{stored[0].record.object}: {what}, in the frame before the push [m]',
                    fontsize=11.5, fontweight='bold')
    figure.legend(handles=handles, loc='upper center', bbox_to_anchor=(0.5, 0.0), ncol=3)


def _title(axes, case):
    load = '' if case.load_kg is None else f', {case.load_kg:g} kg'
    load += f', change {case.noticed}' if case.noticed else ''
    axes.set_title(f'case {case.record.case_id} (n = {case.record.observation_count}{load})',
                   fontsize=9)
    axes.tick_params(labelsize=7)


def _span(case):
    """Side of a square around the mean that holds the ellipse and all outcomes."""
    mean = case.record.outcome.mean
    width, height, _ = case.record.outcome.ellipse(style.SIGMAS_95)
    reach = [max(abs(o.outcome.x_m - mean.x_m), abs(o.outcome.y_m - mean.y_m))
             for o in case.observations]
    return 1.15 * max([width, height] + [2.0 * r for r in reach])


def _draw_outcomes(axes, case, span):
    outcome = case.record.outcome
    geometry.ellipse(axes, outcome, style.SIGMAS_95, facecolor=style.EXPECTED,
                     edgecolor='#b8860b', alpha=0.35, linewidth=0.9, zorder=2)
    for observation in case.observations:
        marker, colour = _SOURCES[observation.source]
        pose = observation.outcome
        axes.plot([pose.x_m, pose.x_m + 0.05 * span * math.cos(pose.yaw_rad)],
                  [pose.y_m, pose.y_m + 0.05 * span * math.sin(pose.yaw_rad)],
                  color=colour, linewidth=0.8, alpha=0.7, zorder=4)
        axes.plot(pose.x_m, pose.y_m, marker, color=colour, markersize=3.4, alpha=0.85, zorder=5)
    geometry.heading(axes, outcome.mean, 0.12 * span, '#b8860b', zorder=6, width=1.8)
    axes.set_xlim(outcome.mean.x_m - span / 2, outcome.mean.x_m + span / 2)
    axes.set_ylim(outcome.mean.y_m - span / 2, outcome.mean.y_m + span / 2)
    axes.set_aspect('equal')
    _title(axes, case)


def _draw_tube(axes, case):
    # As collections: hundreds of separate artists would take a minute.
    sizes = np.array([step.ellipse(style.SIGMAS_95) for step in case.tube])
    axes.add_collection(EllipseCollection(
        sizes[:, 0], sizes[:, 1], np.degrees(sizes[:, 2]), units='xy',
        offsets=[(step.mean.x_m, step.mean.y_m) for step in case.tube],
        transOffset=axes.transData, facecolor=style.EXPECTED, edgecolor='#b8860b', alpha=0.12,
        linewidth=0.4, zorder=2))
    paths = [case.record.object_path] + [o.path for o in case.observations]
    axes.add_collection(LineCollection([[(p.x_m, p.y_m) for p in path] for path in paths if path],
                                       color='#8fb3d9', linewidth=0.7, alpha=0.8, zorder=3))
    geometry.path(axes, [s.mean for s in case.tube], color=style.OBSERVED, linewidth=1.6, zorder=5)
    axes.plot(0.0, 0.0, 's', markersize=4, color=style.TRUTH, zorder=6)
    geometry.heading(axes, case.record.outcome.mean, 0.06, style.OBSERVED, zorder=6, width=1.4)
    axes.set_aspect('equal', adjustable='datalim')
    axes.margins(0.12)
    _title(axes, case)
