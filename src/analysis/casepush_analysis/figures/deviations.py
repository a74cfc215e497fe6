"""How far each push ended from its prediction."""

import math

from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from casepush_analysis import metrics
from casepush_analysis.figures import style

_MANY = 60  # Above this, points instead of bars.
_SMALLEST_P = 1e-6


def draw(pushes, alpha, title):
    """`pushes` in order; those that say nothing of their case are marked in place of a value."""
    figure = style.new_figure(9.4, 6.4)
    position, yaw, p_values = figure.subplots(3, 1, sharex=True)
    tested = [(n, p, metrics.deviation(p)) for n, p in enumerate(pushes, 1) if p.tested]
    colours = [style.verdict_colour(p) for _, p, _ in tested]
    untested = [n for n, p in enumerate(pushes, 1) if not p.tested]
    numbers = [n for n, _, _ in tested]
    _draw_values(position, numbers, [100.0 * d.position_m for _, _, d in tested], colours)
    _draw_values(yaw, numbers, [math.degrees(d.yaw_rad) for _, _, d in tested], colours)
    p_values.scatter(numbers, [max(p.p_value, _SMALLEST_P) for _, p, _ in tested], c=colours,
                     s=12 if len(numbers) > _MANY else 24, linewidths=0.0)
    p_values.axhline(alpha, color=style.REJECTED, linewidth=1.0, linestyle='--')
    for axes in (position, yaw):
        axes.scatter(untested, [0.02] * len(untested), marker='x', s=14, linewidths=1.0,
                     color=style.NEUTRAL, transform=axes.get_xaxis_transform(), zorder=5)
    p_values.set_yscale('log')
    p_values.set_ylim(min([alpha] + [max(p.p_value, _SMALLEST_P) for _, p, _ in tested]) / 3.0, 2.0)
    position.set_ylabel('distance [cm]')
    yaw.set_ylabel('heading [deg]')
    p_values.set_ylabel('p-value')
    p_values.set_xlabel('push')
    p_values.set_xlim(0.2, max(len(pushes), 1) + 0.8)
    p_values.xaxis.set_major_locator(MaxNLocator(integer=True))
    position.set_title(title, loc='left')
    position.legend(handles=[
        Line2D([], [], color=style.ACCEPTED, marker='s', linestyle='', label='as expected'),
        Line2D([], [], color=style.REJECTED, marker='s', linestyle='', label='not as expected'),
        *([Line2D([], [], color=style.NEUTRAL, marker='x', linestyle='',
                  label='failed or first try')] if untested else []),
        Line2D([], [], color=style.REJECTED, linestyle='--', label=f'level {alpha:g}')],
        loc='lower right', bbox_to_anchor=(1.0, 1.01), ncol=4, borderaxespad=0.0)
    return figure


def _draw_values(axes, numbers, values, colours):
    if len(numbers) > _MANY:
        axes.vlines(numbers, 0.0, values, color=colours, linewidth=0.8)
        axes.scatter(numbers, values, c=colours, s=7, linewidths=0.0)
    else:
        axes.bar(numbers, values, color=colours, width=0.66)
    axes.axhline(0.0, color=style.NEUTRAL, linewidth=0.7)
