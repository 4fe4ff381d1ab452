"""How far can a mean or a median be trusted? Intervals of 95 %, by resampling where there are values enough."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

CONFIDENCE = 0.95
RESAMPLES = 2000
FEWEST_TO_RESAMPLE = 10  # a bootstrap of fewer values covers well below 95 %: three values resample to ten different means
CHUNK = 256  # rows whose resamples are at hand at a time: 4 MiB
SEED = 20130321  # of the resampling, so that one table always shows the same intervals

Interval = tuple[float, float]


def mean_interval(values: Sequence[float] | npt.NDArray[Any]) -> Interval:
    """Where the mean of what gave these values lies: Student's t for fewer than 10, above it the bootstrap [Efron 1979].

    One value tells nothing about its own spread: (nan, nan).
    """
    low, high = mean_intervals(np.asarray(values, np.float64)[None])[0]
    return float(low), float(high)


def mean_intervals(rows: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """`mean_interval` of every row, (rows, values) -> (rows, 2)."""
    count = rows.shape[1]
    intervals = np.full((len(rows), 2), np.nan)
    if count >= 2:
        known = np.isfinite(rows).all(axis=1)
        intervals[known] = _by_bootstrap(rows[known]) if count >= FEWEST_TO_RESAMPLE else _by_t(rows[known])
    return intervals


def _by_t(rows: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    count = rows.shape[1]
    reach = _t_quantile((1 + CONFIDENCE) / 2, count - 1) * rows.std(axis=1, ddof=1) / np.sqrt(count)
    return np.stack([rows.mean(axis=1) - reach, rows.mean(axis=1) + reach], axis=1)


def _by_bootstrap(rows: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """The percentile interval of the mean, its levels widened for few values [Hesterberg 2015, section 5.3]."""
    from scipy.special import ndtr

    count = rows.shape[1]
    tail = float(ndtr(np.sqrt(count / (count - 1)) * _t_quantile((1 - CONFIDENCE) / 2, count - 1)))
    drawn = np.random.default_rng(SEED).integers(0, count, (RESAMPLES, count))
    places = drawn + count * np.arange(RESAMPLES)[:, None]
    often = np.bincount(places.ravel(), minlength=places.size).reshape(places.shape) / count  # of each value in each resample, over all
    chunks = [rows[start : start + CHUNK] for start in range(0, len(rows), CHUNK)]
    ends = [np.quantile(np.einsum("rv,sv->rs", chunk, often), [tail, 1 - tail], axis=1).T for chunk in chunks]
    return np.concatenate([np.empty((0, 2)), *ends])


@cache
def _t_quantile(level: float, freedom: int) -> float:
    from scipy.special import stdtrit

    return float(stdtrit(freedom, level))


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
