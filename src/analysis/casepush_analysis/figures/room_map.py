"""The room from above with one task in it: what was planned, expected, and what happened."""

import numpy as np
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.ticker import MultipleLocator
from matplotlib.transforms import ScaledTranslation

from casepush_analysis.figures import geometry, style
from casepush_analysis.se2 import interpolate

_HEIGHTS = LinearSegmentedColormap.from_list('heights', ['#d9dde2', '#8d97a3', '#4d5661'])
_TALL_M = 1.8  # Anything higher is drawn as dark as this.
_MARGIN_M = 1.0  # Around the object's way.
_LABELS_IN = 0.55  # Height of the labels below the x axis.


def draw(recording, entry, whole_room):
    """One task (a TaskAnalysis) in the whole room, or the object's way closely."""
    task, pushes, plans = entry.task, entry.pushes, entry.solved_plans
    figure = style.new_figure(8.6, 8.6)
    axes = figure.add_subplot()
    if recording.room is not None:
        axes.imshow(np.minimum(recording.room.height_m, _TALL_M), origin='lower', cmap=_HEIGHTS,
                    extent=recording.room.extent_m, interpolation='nearest', vmin=0.0, vmax=_TALL_M,
                    zorder=1)
    robot = _clip(recording.robot, task.start_s, entry.end_s)
    truth = _clip(recording.truth.get(task.object_id), task.start_s, entry.end_s)
    tracked = _clip(recording.tracked.get(task.object_id), task.start_s, entry.end_s)
    geometry.path(axes, robot, color=style.ROBOT, linewidth=0.8, alpha=0.6, zorder=2)
    _draw_plans(axes, plans)
    geometry.path(axes, truth, color=style.TRUTH, linewidth=1.8, zorder=4)
    geometry.path(axes, tracked, color=style.TRACKED, linewidth=1.0, zorder=5)
    _draw_pushes(axes, pushes)
    _draw_collisions(axes, recording, entry.collisions or [])
    start = next((poses[0] for poses in (truth, tracked) if poses), None)
    _draw_ends(axes, start, task)
    _frame(axes, _bounds(recording, truth + tracked + [task.map_goal], whole_room))
    _legend(axes, recording, entry, bool(robot), bool(truth), bool(tracked))
    view = 'in the room, seen from above' if whole_room else 'seen closely'
    axes.set_title(f'{task.object_id}: {len(pushes)} pushes {view}', loc='left')
    return figure


def _clip(track, start_s, end_s):
    if track is None:
        return []
    return [p for t, p in zip(track.times_s, track.poses) if start_s <= t <= end_s]


def _draw_plans(axes, plans):
    for number, plan in enumerate(plans):
        poses = [plan.map_start] + [outcome.mean for outcome in plan.outcomes]
        first = number == 0
        axes.plot([p.x_m for p in poses], [p.y_m for p in poses], linestyle=(0, (4, 2)),
                  marker='.', markersize=3.5 if first else 2.0, color=style.PLAN, zorder=3,
                  linewidth=1.3 if first else 0.8, alpha=1.0 if first else 0.55)


def _draw_pushes(axes, pushes):
    for number, push in enumerate(pushes, 1):
        colour = style.verdict_colour(push)
        if push.map_expected is not None:
            geometry.ellipse(axes, push.map_expected, style.SIGMAS_95, facecolor=style.EXPECTED,
                             edgecolor='#b8860b', alpha=0.55, linewidth=0.8, zorder=5.5)
        geometry.heading(axes, push.map_end, 0.16, colour, zorder=7, width=1.4)
        style.label(axes, str(number), push.map_end.x_m, push.map_end.y_m, colour, 7.0)


def _draw_collisions(axes, recording, collisions):
    for collision in collisions:
        track = (recording.robot if collision.body == 'robot'
                 else recording.truth.get(collision.body))
        pose = interpolate(track.times_s, track.poses, collision.start_s) if track else None
        if pose is not None:
            axes.plot(pose.x_m, pose.y_m, 'x', markersize=11, markeredgewidth=2.8,
                      color=style.REJECTED, zorder=10)


def _draw_ends(axes, start, task):
    if start is not None:
        axes.plot(start.x_m, start.y_m, 'o', markersize=10, markerfacecolor='white',
                  markeredgecolor=style.TRUTH, markeredgewidth=2.0, zorder=9)
        geometry.heading(axes, start, 0.35, style.TRUTH, zorder=9, width=2.0)
    goal = task.map_goal
    axes.add_patch(Circle((goal.x_m, goal.y_m), task.position_tolerance_m, facecolor=style.GOAL,
                          edgecolor=style.GOAL, alpha=0.25, zorder=3))
    axes.plot(goal.x_m, goal.y_m, '*', markersize=15, color=style.GOAL, markeredgecolor='white',
              zorder=9)
    geometry.heading(axes, goal, 0.35, style.GOAL, zorder=8, width=2.0)


def _bounds(recording, poses, whole_room):
    """Left, right, bottom, top of what to show."""
    if whole_room and recording.room is not None:
        return recording.room.extent_m
    xs, ys = [p.x_m for p in poses], [p.y_m for p in poses]
    return (min(xs) - _MARGIN_M, max(xs) + _MARGIN_M, min(ys) - _MARGIN_M, max(ys) + _MARGIN_M)


def _frame(axes, bounds):
    left, right, bottom, top = bounds
    axes.set_xlim(left - 0.1, right + 0.1)
    axes.set_ylim(bottom - 0.1, top + 0.1)
    axes.set_aspect('equal')
    axes.set_xlabel('x in the map [m]')
    axes.set_ylabel('y in the map [m]')
    step = 1.0 if max(right - left, top - bottom) <= 20.0 else 5.0
    axes.xaxis.set_major_locator(MultipleLocator(step))
    axes.yaxis.set_major_locator(MultipleLocator(step))


def _legend(axes, recording, entry, robot, truth, tracked):
    pushes = bool(entry.pushes)

    def line(colour, label, **options):
        return Line2D([], [], color=colour, label=label, **options)

    entries = [(True, line(style.TRUTH, 'start', marker='o', markerfacecolor='white',
                           markersize=8, linestyle='')),
               (True, line(style.GOAL, 'goal and its tolerance', marker='*', markersize=11,
                           linestyle='')),
               (truth, line(style.TRUTH, 'object, ground truth', linewidth=1.8)),
               (tracked, line(style.TRACKED, 'object, as tracked', linewidth=1.0)),
               (robot, line(style.ROBOT, 'robot', linewidth=0.9)),
               (entry.solved_plans, line(style.PLAN, 'plans (the first one bold)', linestyle='--')),
               (pushes, Patch(facecolor=style.EXPECTED, edgecolor='#b8860b', alpha=0.6,
                              label='expected after a push (95 %)')),
               (pushes, line(style.ACCEPTED, 'observed, as expected', marker='o', markersize=4)),
               (pushes, line(style.REJECTED, 'observed, not as expected', marker='o',
                             markersize=4)),
               (any(not p.tested for p in entry.pushes),
                line(style.NEUTRAL, 'observed, failed or first try', marker='o', markersize=4)),
               (entry.collisions, line(style.REJECTED, 'collision', marker='x', markersize=9,
                                       markeredgewidth=2.5, linestyle='')),
               (recording.room is not None, Patch(facecolor='#8d97a3',
                                                  label='walls and furniture (dark: tall)'))]
    below_labels = ScaledTranslation(0.0, -_LABELS_IN, axes.figure.dpi_scale_trans)
    axes.legend(handles=[handle for wanted, handle in entries if wanted], loc='upper center',
                bbox_to_anchor=(0.5, 0.0), bbox_transform=axes.transAxes + below_labels, ncol=3,
                borderaxespad=0.0)
