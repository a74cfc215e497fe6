"""Predicted against observed: each observation against what the others of its case predict."""

import numpy as np

from casepush_analysis import calibration
from casepush_analysis.figures import style

_TESTS = (('p_value', 'Hotelling\'s $T^2$', style.ACCEPTED),
          ('plug_in_p_value', 'plug-in $\\chi^2$', style.REJECTED))


def draw(stored):
    tested = [o for c in stored for o in c.observations if o.p_value is not None]
    figure = style.new_figure(10.2, 4.8)
    coverage, tail = figure.subplots(1, 2)
    line = np.array([0.0, 1.0])
    bound = calibration.dkw_bound(len(tested))
    coverage.fill_between(line, line - bound, line + bound, color=style.EXPECTED, alpha=0.3,
                          linewidth=0.0, label='95 % band if calibrated')
    coverage.plot(line, line, color='#b8860b', linewidth=1.2)
    for key, label, colour in _TESTS:
        values = np.sort([1.0 - getattr(o, key) for o in tested])
        observed = np.arange(1, len(values) + 1) / len(values)
        coverage.step(values, observed, where='post', color=colour, linewidth=1.6, label=label)
    coverage.set_xlim(0.0, 1.0)
    coverage.set_ylim(0.0, 1.0)
    coverage.set_aspect('equal')
    coverage.set_xlabel('predicted: share of outcomes in the region')
    coverage.set_ylabel('observed: share of outcomes in the region')
    coverage.legend(loc='upper left')
    coverage.set_title(f'{stored[0].record.object}: {len(tested)} observations, each left out',
                       loc='left', fontsize=10.5)
    _draw_rejections(tail, tested)
    return figure


def _draw_rejections(axes, tested):
    """False alarms against the level they are to be held at, where it matters."""
    alphas = np.logspace(-3, -0.5, 60)
    axes.plot(alphas, alphas, color='#b8860b', linewidth=1.2, label='calibrated')
    floor = 0.5 / len(tested)
    for key, label, colour in _TESTS:
        values = np.array([getattr(o, key) for o in tested])
        rates = [max(floor, float(np.mean(values < a))) for a in alphas]
        axes.plot(alphas, rates, color=colour, linewidth=1.6, label=label)
        low, high = zip(*(calibration.wilson_interval(int(np.sum(values < a)), len(values))
                          for a in alphas))
        axes.fill_between(alphas, np.maximum(low, floor), high, color=colour, alpha=0.15,
                          linewidth=0.0)
    axes.axvline(calibration.DEFAULT_ALPHA, color=style.NEUTRAL, linewidth=0.9, linestyle='--')
    axes.set_xscale('log')
    axes.set_yscale('log')
    axes.set_ylim(floor, 1.0)
    axes.set_xlabel('level of the test')
    axes.set_ylabel('rejected')
    axes.legend(loc='lower right')
    axes.set_title('False alarms (bands: 95 %)', loc='left', fontsize=10.5)
