"""Are the p-values uniform, as they are when the cases are right?"""

import numpy as np

from casepush_analysis import calibration
from casepush_analysis.figures import style


def draw(pushes, alpha, title):
    values = sorted(p.p_value for p in calibration.tested_pushes(pushes))
    figure = style.new_figure(9.4, 4.2)
    histogram, quantiles = figure.subplots(1, 2)
    _draw_histogram(histogram, values, alpha)
    _draw_quantiles(quantiles, values)
    histogram.set_title(title, loc='left')
    return figure


def _draw_histogram(axes, values, alpha):
    bins = 20 if len(values) >= 100 else 10
    edges = np.linspace(0.0, 1.0, bins + 1)
    axes.hist(values, edges, color='#8fb3d9', edgecolor='white')
    expected = len(values) / bins
    spread = 1.96 * np.sqrt(expected * (1.0 - 1.0 / bins))
    axes.axhspan(max(0.0, expected - spread), expected + spread, color=style.EXPECTED, alpha=0.3,
                 linewidth=0.0, label='95 % of bins if the cases are right')
    axes.axhline(expected, color='#b8860b', linewidth=1.2)
    axes.axvline(alpha, color=style.REJECTED, linewidth=1.2, linestyle='--',
                 label=f'rejected below {alpha:g}')
    axes.set_xlim(0.0, 1.0)
    axes.margins(y=0.25)
    axes.set_xlabel('p-value of $T^2$')
    axes.set_ylabel('pushes')
    axes.legend(loc='upper right')


def _draw_quantiles(axes, values):
    count = len(values)
    uniform = (np.arange(1, count + 1) - 0.5) / count
    bound = calibration.dkw_bound(count)
    line = np.array([0.0, 1.0])
    axes.fill_between(line, line - bound, line + bound, color=style.EXPECTED, alpha=0.3,
                      linewidth=0.0, label='95 % band if the cases are right')
    axes.plot(line, line, color='#b8860b', linewidth=1.2)
    axes.plot(uniform, values, 'o', markersize=3.0, color=style.TRUTH, label='pushes')
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.set_aspect('equal')
    axes.set_xlabel('p-value if the cases are right')
    axes.set_ylabel('p-value observed')
    axes.legend(loc='upper left')
