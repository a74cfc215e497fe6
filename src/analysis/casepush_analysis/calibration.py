"""Do predictions hold as often as they claim? If a case is right, its p-values are uniform."""

import math
from dataclasses import dataclass
from typing import Optional

DEFAULT_ALPHA = 0.01
CONFIDENCE = 0.95
NORMAL_QUANTILE = 1.959963984540054  # Of (1 + CONFIDENCE) / 2.


@dataclass
class Calibration:
    """Summary of a set of tested predictions."""

    tested: int
    rejected: int
    alpha: float
    rejected_fraction: Optional[float]
    fraction_low: Optional[float]  # 95 % interval (Wilson) of the true rejection rate.
    fraction_high: Optional[float]
    excess_p: Optional[float]  # Chance of at least so many rejections if the rate were alpha.
    ks_distance: Optional[float]  # Largest gap between the p-values' distribution and uniform.
    ks_critical: Optional[float]  # A gap beyond this has less than 5 % chance if uniform.


def tested_pushes(pushes):
    """Pushes with a meaningful p-value. An untested prediction reports T^2 = 0 and p = 1."""
    return [p for p in pushes if p.tested and not (p.t_squared == 0.0 and p.p_value == 1.0)]


def calibrate(pushes, alpha=DEFAULT_ALPHA):
    """Calibration of the given pushes' predictions."""
    tested = tested_pushes(pushes)
    count = len(tested)
    rejected = sum(p.rejected for p in tested)
    if count == 0:
        return Calibration(0, 0, alpha, None, None, None, None, None, None)
    low, high = wilson_interval(rejected, count)
    return Calibration(count, rejected, alpha, rejected / count, low, high,
                       binomial_tail(rejected, count, alpha),
                       uniform_distance([p.p_value for p in tested]), dkw_bound(count))


def wilson_interval(successes, count):
    """95 % interval of a rate (E. B. Wilson, 1927)."""
    z2 = NORMAL_QUANTILE**2
    rate = successes / count
    centre = (rate + z2 / (2 * count)) / (1 + z2 / count)
    half = (NORMAL_QUANTILE / (1 + z2 / count)
            * math.sqrt(rate * (1 - rate) / count + z2 / (4 * count**2)))
    return max(0.0, centre - half), min(1.0, centre + half)


def binomial_tail(successes, count, rate):
    """Probability of at least so many successes."""
    below = sum(math.comb(count, k) * rate**k * (1 - rate)**(count - k) for k in range(successes))
    return min(1.0, max(0.0, 1.0 - below))


def uniform_distance(values):
    """Kolmogorov-Smirnov distance of a sample from the uniform distribution on [0, 1]."""
    ordered = sorted(values)
    count = len(ordered)
    return max(max((i + 1) / count - v, v - i / count) for i, v in enumerate(ordered))


def dkw_bound(count):
    """Distance that a uniform sample exceeds with at most 5 % (Dvoretzky-Kiefer-Wolfowitz)."""
    return math.sqrt(math.log(2.0 / (1.0 - CONFIDENCE)) / (2.0 * count))


def infer_alpha(pushes):
    """The level that the verdicts were given at, as far as they tell it.

    The default if it fits all verdicts; otherwise the middle of the gap between the largest
    rejected and the smallest accepted p-value.
    """
    rejected = [p.p_value for p in tested_pushes(pushes) if p.rejected]
    accepted = [p.p_value for p in tested_pushes(pushes) if not p.rejected]
    low, high = max(rejected, default=0.0), min(accepted, default=1.0)
    if low <= DEFAULT_ALPHA <= high or low > high:
        return DEFAULT_ALPHA
    return (low + high) / 2.0
