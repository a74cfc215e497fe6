"""Poses in the plane, as casepush/common/pose2.h has them."""

import math
from dataclasses import dataclass

import numpy as np


def wrap_angle(angle_rad):
    """Angle wrapped to (-pi, pi] [rad]."""
    wrapped = math.remainder(angle_rad, 2.0 * math.pi)
    return math.pi if wrapped <= -math.pi else wrapped


@dataclass(frozen=True)
class Pose2:
    """A pose in SE(2): position [m] and heading [rad]; a_T_b maps b-coordinates to a."""

    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0

    def __matmul__(self, other):
        c, s = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return Pose2(self.x_m + c * other.x_m - s * other.y_m,
                     self.y_m + s * other.x_m + c * other.y_m,
                     wrap_angle(self.yaw_rad + other.yaw_rad))

    def inverse(self):
        c, s = math.cos(self.yaw_rad), math.sin(self.yaw_rad)
        return Pose2(-c * self.x_m - s * self.y_m, s * self.x_m - c * self.y_m,
                     wrap_angle(-self.yaw_rad))

    def distance_m(self, other):
        return math.hypot(other.x_m - self.x_m, other.y_m - self.y_m)

    def yaw_difference_rad(self, other):
        """Heading of `other` minus this heading, wrapped."""
        return wrap_angle(other.yaw_rad - self.yaw_rad)

    def is_finite(self):
        return all(math.isfinite(v) for v in (self.x_m, self.y_m, self.yaw_rad))


def log_se2(pose):
    """Logarithm of SE(2): body twist (vx, vy, wz) that reaches `pose` in unit time."""
    half = pose.yaw_rad / 2.0
    # theta/2 * cot(theta/2), whose limit at 0 is 1.
    diagonal = half / math.tan(half) if abs(half) > 1e-6 else 1.0 - half * half / 3.0
    return np.array([diagonal * pose.x_m + half * pose.y_m,
                     -half * pose.x_m + diagonal * pose.y_m, pose.yaw_rad])


@dataclass(frozen=True)
class PoseGaussian:
    """x = mean * exp(e), e ~ N(0, covariance) in the frame of the mean; rows are x, y, yaw."""

    mean: Pose2
    covariance: np.ndarray

    def error(self, pose):
        """Deviation e of `pose` from the mean, in the frame of the mean [m, m, rad]."""
        return log_se2(self.mean.inverse() @ pose)

    def ellipse(self, sigmas):
        """Position ellipse in the parent frame: full width, full height [m], angle [rad]."""
        values, vectors = np.linalg.eigh(self.covariance[:2, :2])
        values = np.sqrt(np.maximum(values, 0.0))
        angle = math.atan2(vectors[1, 1], vectors[0, 1]) + self.mean.yaw_rad
        return 2.0 * sigmas * values[1], 2.0 * sigmas * values[0], wrap_angle(angle)


def interpolate(times, poses, time):
    """Pose at `time`: linear between samples, angles the short way; None outside the samples."""
    if len(times) == 0 or time < times[0] or time > times[-1]:
        return None
    right = int(np.searchsorted(times, time))
    if times[right] == time:
        return poses[right]
    left = right - 1
    t = (time - times[left]) / (times[right] - times[left])
    a, b = poses[left], poses[right]
    return Pose2(a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m),
                 wrap_angle(a.yaw_rad + t * a.yaw_difference_rad(b)))
