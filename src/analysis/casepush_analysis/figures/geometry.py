"""Poses, paths and ellipses on a pair of axes."""

import math

from matplotlib.patches import Ellipse

JUMP_M = 0.5  # Between neighbouring samples: the object was carried, not pushed.


def path(axes, poses, **options):
    """A line through poses, broken where an object was put somewhere else."""
    xs, ys, previous = [], [], None
    for pose in poses:
        if previous is not None and previous.distance_m(pose) > JUMP_M:
            xs.append(math.nan)
            ys.append(math.nan)
        xs.append(pose.x_m)
        ys.append(pose.y_m)
        previous = pose
    axes.plot(xs, ys, **options)


def heading(axes, pose, length_m, colour, zorder=6, width=0.9):
    """A dot with a stroke that shows where the pose faces."""
    axes.plot([pose.x_m, pose.x_m + length_m * math.cos(pose.yaw_rad)],
              [pose.y_m, pose.y_m + length_m * math.sin(pose.yaw_rad)],
              color=colour, linewidth=width, zorder=zorder, solid_capstyle='round')
    axes.plot(pose.x_m, pose.y_m, 'o', color=colour, markersize=2.8, zorder=zorder)


def ellipse(axes, gaussian, sigmas, **options):
    width, height, angle = gaussian.ellipse(sigmas)
    axes.add_patch(Ellipse((gaussian.mean.x_m, gaussian.mean.y_m), width, height,
                           angle=math.degrees(angle), **options))
