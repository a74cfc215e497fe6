"""The cases as in the paper's Fig. 3b: robot trajectories green, object trajectories red."""

from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from casepush_analysis.figures import geometry, style
from casepush_analysis.se2 import Pose2

_ROBOT = '#2ca02c'
_OBJECT = '#d62728'


def draw(cases):
    figure = style.new_figure(8.6, 8.6)
    axes = figure.add_subplot()
    for case in cases:
        _draw_case(axes, case)
    axes.plot(0.0, 0.0, 's', markersize=9, color=style.TRUTH, zorder=8)
    geometry.heading(axes, Pose2(), 0.25, style.TRUTH, zorder=8, width=2.2)
    axes.set_aspect('equal')
    axes.margins(0.06)
    axes.set_xlabel('x before the push [m]')
    axes.set_ylabel('y before the push [m]')
    axes.set_title(f'{len(cases)} cases of {", ".join(sorted({c.object for c in cases}))}, '
                   'in the frame of the object before the push', loc='left')
    axes.legend(handles=[
        Line2D([], [], color=style.TRUTH, marker='s', linewidth=2, label='object before the push'),
        Line2D([], [], color=_ROBOT, linewidth=1.6, marker='o', markersize=9,
               markerfacecolor='#2ca02c30', label='robot while it pushes'),
        Line2D([], [], color=_OBJECT, linewidth=1.6, label='object until it rests'),
        Line2D([], [], color=_OBJECT, marker='o', linewidth=1.2, label='mean resting pose'),
        Patch(facecolor=style.EXPECTED, edgecolor='#b8860b', alpha=0.5,
              label='uncertainty of the resting place (95 %)')],
        loc='upper center', bbox_to_anchor=(0.5, -0.07), ncol=3, borderaxespad=0.0)
    return figure


def _draw_case(axes, case):
    pushing = case.robot_path[:case.push_steps] or case.robot_path
    geometry.path(axes, pushing, color=_ROBOT, linewidth=1.5, zorder=4)
    geometry.path(axes, case.object_path, color=_OBJECT, linewidth=1.3, zorder=5)
    geometry.ellipse(axes, case.outcome, style.SIGMAS_95, facecolor=style.EXPECTED,
                     edgecolor='#b8860b', alpha=0.4, linewidth=0.8, zorder=3)
    geometry.heading(axes, case.outcome.mean, 0.14, _OBJECT, zorder=7, width=1.6)
    number, start, end = str(case.case_id), pushing[0], case.outcome.mean
    style.label(axes, number, start.x_m, start.y_m, _ROBOT, 8.5, (-14, -10))
    style.label(axes, number, end.x_m, end.y_m, _OBJECT, 8.5)
    axes.plot(pushing[0].x_m, pushing[0].y_m, 'o', markersize=9, markerfacecolor='#2ca02c30',
              markeredgecolor=_ROBOT, zorder=6)
    geometry.heading(axes, pushing[0], 0.1, _ROBOT, zorder=6, width=1.4)
