"""What the robot was doing when (a Gantt chart)."""

from matplotlib.patches import Patch

from casepush_analysis.figures import style

_ORDER = ('planning', 'approach', 'dock', 'push', 'rest')


def draw(segments, pushes, start_s, title):
    """Segments of one part of the recording; time counts from `start_s`."""
    busy = [s for s in segments if s.phase != 'idle']
    names = sorted({s.phase for s in busy},
                   key=lambda n: (_ORDER.index(n) if n in _ORDER else len(_ORDER), n))
    colours = style.phase_colours(names)
    figure = style.new_figure(9.4, 1.5 + 0.42 * len(names))
    axes = figure.add_subplot()
    rows = {name: len(names) - 1 - i for i, name in enumerate(names)}
    for name in names:
        bars = [(s.start_s - start_s, s.duration_s) for s in busy if s.phase == name]
        axes.broken_barh(bars, (rows[name] - 0.36, 0.72), facecolors=colours[name],
                         edgecolors=colours[name], linewidth=0.3)
    _mark_rejections(axes, pushes, start_s, len(names))
    axes.set_yticks([rows[n] for n in names])
    axes.set_yticklabels([f'{n}  ({sum(s.duration_s for s in busy if s.phase == n):.1f} s)'
                          for n in names])
    axes.set_ylim(-0.6, len(names) - 0.4)
    axes.set_xlabel('time since the beginning [s]')
    axes.grid(axis='y', visible=False)
    axes.margins(x=0.01)
    axes.set_title(title, loc='left')
    return figure


def _mark_rejections(axes, pushes, start_s, rows):
    rejected = [p.end_s - start_s for p in pushes if p.rejected]
    if rejected:
        axes.vlines(rejected, -0.6, rows - 0.4, color=style.REJECTED, linewidth=0.9,
                    linestyle=(0, (3, 2)), zorder=5)
        axes.legend(handles=[Patch(facecolor='none', edgecolor=style.REJECTED, linestyle='--',
                                   label='prediction rejected')],
                    loc='lower right', bbox_to_anchor=(1.0, 1.01), borderaxespad=0.0)
