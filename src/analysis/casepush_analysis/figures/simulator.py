"""The simulator against its laws, and its two models of casters against each other.

Takes the JSON of `casepush bench sim --laws --fidelity`. Marks are measured, lines are the laws.
"""

import math

import numpy as np
from matplotlib.patches import Ellipse
from PIL import Image

from casepush_analysis.figures import style

MODELS = ('featherstone', 'planar')
MARKS = {'featherstone': 'o', 'planar': 'x'}
COLOURS = {'featherstone': '#1f5fa8', 'planar': '#d2691e'}
FLOORS = {2.2: 'concrete', 2.4: 'tile', 3.3: 'asphalt', 4.5: 'carpet'}
FLOOR_COLOURS = {2.2: '#7f7f7f', 2.4: '#2b8cbe', 3.3: '#31a354', 4.5: '#b5477a'}
ELLIPSE_SIGMA = 2.0
PALETTE = 256


def draw_laws(bench, path):
    """Push force, start-up force, coasting and trailing of a utility cart."""
    with style.look():
        figure = style.new_figure(8.4, 6.8)
        axes = figure.subplots(2, 2)
        laws = bench['laws']
        _push_force(axes[0, 0], laws)
        _start(axes[0, 1], laws)
        _coast(axes[1, 0], laws)
        _trailing(axes[1, 1], laws)
        _save(figure, path)


def draw_models(bench, path):
    """Where one push ends, over random swivels; and differences by step size."""
    with style.look():
        figure = style.new_figure(8.4, 3.6)
        axes = figure.subplots(1, 2)
        _outcomes(axes[0], bench)
        _fidelity(axes[1], bench)
        _save(figure, path)


def _save(figure, path):
    """With a palette: a few flat colours need no more, and pictures in docs should stay small."""
    style.save(figure, path)
    with Image.open(path) as picture:
        small = picture.convert('RGB').quantize(PALETTE)
    small.save(path, optimize=True)


def _millimetres(lever_arm_m):
    return round(1000.0 * lever_arm_m, 1)


def _push_force(axes, laws):
    rows = laws['featherstone']['push_force']
    radii = sorted({row['wheel_radius_m'] for row in rows})
    for lever_mm in sorted(FLOORS):
        for radius_m, line in zip(radii, ('-', '--')):
            chosen = {model: [row for row in laws[model]['push_force']
                              if _millimetres(row['rolling_lever_arm_m']) == lever_mm
                              and row['wheel_radius_m'] == radius_m] for model in MODELS}
            first = chosen['featherstone']
            slope = first[0]['law_n'] / first[0]['weight_n']
            weight_n = np.array([0.0, max(row['weight_n'] for row in first) * 1.05])
            axes.plot(weight_n, slope * weight_n, line, color=FLOOR_COLOURS[lever_mm], lw=1)
            for model in MODELS:
                axes.plot([row['weight_n'] for row in chosen[model]],
                          [row['force_n'] for row in chosen[model]], MARKS[model],
                          color=FLOOR_COLOURS[lever_mm], fillstyle='none')
    for lever_mm, name in FLOORS.items():
        axes.plot([], [], color=FLOOR_COLOURS[lever_mm], label=f'{name}, f = {lever_mm} mm')
    for radius_m, line in zip(radii, ('-', '--')):
        axes.plot([], [], line, color='black', label=f'law f W / r, r = {1000 * radius_m:.1f} mm')
    for model in MODELS:
        axes.plot([], [], MARKS[model], color='black', fillstyle='none', label=model)
    axes.set(title='Steady push', xlabel='weight [N]', ylabel='force [N]', xlim=(0, None),
             ylim=(0, None))
    axes.legend(fontsize=7.5)


def _start(axes, laws):
    for model in MODELS:
        start = laws[model]['start']
        for kind, line in (('aligned', '--'), ('across', '-')):
            label = f'{model}, wheels {"across" if kind == "across" else "aligned"}'
            axes.plot(start[kind]['moved_m'], start[kind]['force_n'], line, color=COLOURS[model],
                      lw=2.5 if model == 'featherstone' else 1.2, label=label,
                      alpha=0.6 if model == 'featherstone' else 1.0)
    axes.axhline(laws['featherstone']['start']['law_n'], color='black', lw=0.8, ls=':',
                 label='law f W / r')
    axes.set(title='Start of a cart of 40 kg at 20 mm/s²', xlabel='moved [m]',
             ylabel='force [N]', ylim=(0, None))
    axes.legend(fontsize=7.5)


def _coast(axes, laws):
    for model in MODELS:
        for row in laws[model]['coast']:
            lever_mm = _millimetres(row['rolling_lever_arm_m'])
            axes.plot(row['moved_m'][::2], row['speed_mps'][::2], MARKS[model], fillstyle='none',
                      ms=5, color=FLOOR_COLOURS[lever_mm])
    for row in laws['featherstone']['coast']:
        lever_mm = _millimetres(row['rolling_lever_arm_m'])
        moved_m = np.linspace(0.0, row['law_m'], 100)
        speed = row['speed_mps'][0] * np.sqrt(np.maximum(0.0, 1.0 - moved_m / row['law_m']))
        axes.plot(moved_m, speed, color=FLOOR_COLOURS[lever_mm], lw=1,
                  label=f'law, {FLOORS[lever_mm]}')
    for model in MODELS:
        axes.plot([], [], MARKS[model], color='black', fillstyle='none', label=model)
    axes.set(title='Coasting with trailing casters', xlabel='moved [m]', ylabel='speed [m/s]',
             xlim=(0, None), ylim=(0, None))
    axes.legend(fontsize=7.5)


def _trailing(axes, laws):
    for model in MODELS:
        trailing = laws[model]['trailing']
        angles_deg = np.abs(np.degrees(np.array(trailing['swivel_rad'])))
        for caster in range(angles_deg.shape[1]):
            axes.semilogy(trailing['moved_m'], np.maximum(angles_deg[:, caster], 1e-3),
                          '-' if model == 'featherstone' else '--', color=COLOURS[model], lw=1.2,
                          label=model if caster == 0 else None)
    axes.axhline(0.5, color='black', lw=0.8, ls=':', label='0.5°')
    axes.set(title='Swivels from random angles', xlabel='moved [m]',
             ylabel='angle to the way [°]', ylim=(0.01, 200))
    axes.legend(fontsize=7.5)


def _outcomes(axes, bench):
    for model in MODELS:
        points = 100.0 * np.array(bench['first_push'][model])[:, :2]
        axes.plot(points[:, 0], points[:, 1], MARKS[model], color=COLOURS[model], ms=5,
                  fillstyle='none', label=model)
        if len(points) > 2:
            axes.add_patch(_ellipse(points, COLOURS[model]))
    axes.set(title=f'Ends of one push of {bench["object"]}, 2 σ',
             xlabel='x in the start frame [cm]', ylabel='y [cm]')
    axes.axis('equal')
    axes.legend(fontsize=7.5)


def _ellipse(points, colour):
    values, vectors = np.linalg.eigh(np.cov(points.T))
    width, height = 2.0 * ELLIPSE_SIGMA * np.sqrt(np.maximum(values, 0.0))
    angle_deg = math.degrees(math.atan2(vectors[1, 0], vectors[0, 0]))
    return Ellipse(points.mean(axis=0), width, height, angle=angle_deg, fill=False, color=colour)


def _fidelity(axes, bench):
    angle = axes.twinx()
    for model in MODELS:
        rows = sorted((row for row in bench['fidelity'] if row['caster_model'] == model),
                      key=lambda row: row['step_s'])
        rate_hz = [1.0 / row['step_s'] for row in rows]
        axes.plot(rate_hz, [100.0 * row['difference_m']['median'] for row in rows], '-o',
                  color=COLOURS[model], label=f'{model}, position')
        angle.plot(rate_hz, [math.degrees(row['difference_rad']['median']) for row in rows], ':s',
                   color=COLOURS[model], fillstyle='none', label=f'{model}, yaw')
    reference_hz = round(1.0 / bench['fidelity'][0]['reference_step_s'])
    axes.set(title=f'Median difference from {reference_hz} steps/s',
             xlabel='steps per second', ylabel='position [cm]', ylim=(0, None))
    angle.set(ylabel='yaw [°]', ylim=(0, None))
    angle.grid(False)
    axes.set_xscale('log', base=2)
    axes.minorticks_off()
    ticks = sorted({round(1.0 / row['step_s']) for row in bench['fidelity']})
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    handles = [h for a in (axes, angle) for h in a.get_legend_handles_labels()[0]]
    axes.legend(handles=handles, fontsize=7.5, loc='lower left')
