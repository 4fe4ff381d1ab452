"""How far can a mean or a median be trusted? Intervals of 95 %, by resampling where there are values enough."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

CONFIDENCE = 0.95
RESAMPLES = 2000
FEWEST_TO_RESAMPLE = 10  # a bootstrap of fewer values covers well below 95 %: three values resample to ten different means
SEED = 20130321  # of the resampling, so that one table always shows the same intervals

Interval = tuple[float, float]
Statistic = Callable[..., npt.NDArray[np.float64]]  # of an array, along an axis


def mean_interval(values: Sequence[float] | npt.NDArray[Any]) -> Interval:
    """Where the mean of what gave these values lies: Student's t for fewer than 10, above it the bootstrap [Efron 1979].

    One value tells nothing about its own spread: (nan, nan).
    """
    given = np.asarray(values, np.float64)
    if given.size < 2 or not np.isfinite(given).all():
        return np.nan, np.nan
    if given.size >= FEWEST_TO_RESAMPLE:
        return _percentiles(resampled(given, np.mean), given.size)
    from scipy.stats import t

    middle, error = float(given.mean()), float(given.std(ddof=1)) / np.sqrt(given.size)
    reach = float(t.ppf((1 + CONFIDENCE) / 2, given.size - 1)) * error
    return middle - reach, middle + reach


def median_interval(values: Sequence[float] | npt.NDArray[Any]) -> Interval:
    """Where the median of what gave these values lies, for any distribution: the k-th smallest and k-th largest of n independent values.

    They miss the median with the chance 2 P(B < k), B binomial of n and 1/2 [Conover 1999, 3.2]. (nan, nan) for fewer than six values,
    where even the smallest and the largest miss it more often than 5 %.
    """
    ordered = np.sort(np.asarray(values, np.float64))
    k = _outer_rank(ordered.size)
    if k == 0 or not np.isfinite(ordered).all():
        return np.nan, np.nan
    return float(ordered[k - 1]), float(ordered[-k])


@cache
def _outer_rank(count: int) -> int:
    """The largest k with P(B < k) <= 2.5 %, B binomial of `count` and 1/2; 0 where there is none."""
    k, below = 0, 0.0
    while count and 2 * (below := below + math.comb(count, k) / 2**count) <= 1 - CONFIDENCE:
        k += 1
    return k


def resampled(values: npt.NDArray[np.float64], statistic: Statistic) -> npt.NDArray[np.float64]:
    """A statistic of RESAMPLES draws with replacement, along the first axis of the values."""
    drawn = np.random.default_rng(SEED).integers(0, len(values), (RESAMPLES, len(values)))
    return np.asarray(statistic(values[drawn], axis=1))


def _percentiles(statistics: npt.NDArray[np.float64], count: int) -> Interval:
    """The percentile interval, its levels widened for few values [Hesterberg 2015, section 5.3]."""
    from scipy.stats import norm, t

    tail = float(norm.cdf(np.sqrt(count / (count - 1)) * t.ppf((1 - CONFIDENCE) / 2, count - 1)))
    low, high = np.quantile(statistics, [tail, 1 - tail])
    return float(low), float(high)
