"""One look for all figures."""

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

DPI = 130
# Axes of the 95 % ellipse of a planar Gaussian in standard deviations: sqrt(-2 ln 0.05).
SIGMAS_95 = 2.4477468306808166

TRUTH = '#1f3a5f'
TRACKED = '#e07b39'
PLAN = '#7b8ca6'
EXPECTED = '#f2c230'
OBSERVED = '#c0392b'
ACCEPTED = '#2e7d5b'
REJECTED = '#c0392b'
ROBOT = '#2e8b57'
GOAL = '#6a3d9a'
NEUTRAL = '#5c6670'
PHASES = {'planning': '#6a3d9a', 'approach': '#8fb3d9', 'dock': '#4a7fb5', 'push': '#c0392b',
          'rest': '#f2c230', 'idle': '#e3e6ea'}
OTHER_PHASES = ('#7b8ca6', '#a6bddb', '#b8a38a', '#9aa89a')

_LOOK = {
    'font.family': 'DejaVu Sans', 'font.size': 9.5, 'axes.titlesize': 11.5,
    'axes.titleweight': 'bold', 'axes.edgecolor': '#9aa3ad',
    'axes.labelcolor': '#333a42', 'xtick.color': '#5c6670', 'ytick.color': '#5c6670',
    'axes.spines.top': False, 'axes.spines.right': False, 'axes.grid': True,
    'grid.color': '#e8ebef', 'grid.linewidth': 0.8, 'axes.axisbelow': True,
    'legend.frameon': True, 'legend.framealpha': 0.92, 'legend.edgecolor': '#d5dae0',
    'legend.fontsize': 8.5,
}


def look():
    """Context in which figures are drawn: the same on every machine, whatever its matplotlibrc."""
    return matplotlib.rc_context({**matplotlib.rcParamsDefault, **_LOOK})


def new_figure(width_in, height_in):
    figure = Figure(figsize=(width_in, height_in), constrained_layout=True)
    FigureCanvasAgg(figure)
    return figure


def save(figure, path):
    """Writes a PNG that depends on nothing but what is drawn."""
    figure.savefig(path, dpi=DPI, facecolor='white', metadata={'Software': None},
                   bbox_inches='tight', pad_inches=0.12)


def verdict_colour(push):
    """Grey for a push that says nothing of its case: broken up, or tried for the first time."""
    if push.rejected:
        return REJECTED
    return ACCEPTED if push.tested else NEUTRAL


def label(axes, text, x, y, colour, size, offset=(4, 4)):
    """A small text beside a point, legible on any background."""
    axes.annotate(text, (x, y), xytext=offset, textcoords='offset points', fontsize=size,
                  fontweight='bold', color=colour, zorder=11,
                  path_effects=[withStroke(linewidth=2.0, foreground='white')])


def phase_colours(names):
    """A colour for each phase, also for phases that are new."""
    spare = iter(OTHER_PHASES * (1 + len(names) // len(OTHER_PHASES)))
    return {name: PHASES[name] if name in PHASES else next(spare) for name in names}
