"""How long does a frame take? A warm-up, then repeats until their median settles."""

from __future__ import annotations

import dataclasses
import gc
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from interreflect.study.interface import Frame, Profile

SETTLED = 0.02  # standard error of the median, as a share of it
NORMAL_FROM_MAD = 1.4826  # standard deviation over median absolute deviation of a normal distribution
MEDIAN_FROM_MEAN = math.sqrt(math.pi / 2)  # standard error of the median over that of the mean


@dataclasses.dataclass(frozen=True)
class Timing:
    """Times of the repeats: median, 95th percentile, and the median of each stage."""

    repeats: int
    milliseconds: float
    milliseconds_p95: float
    stages: dict[str, dict[str, Any]]  # name -> milliseconds, bytes, counts


def settled(milliseconds: Sequence[float]) -> bool:
    """Is the median known to 2 %? Its standard error is sqrt(pi/2) 1.4826 MAD / sqrt(n), which outliers do not move."""
    times = np.asarray(milliseconds)
    median = float(np.median(times))
    deviation = NORMAL_FROM_MAD * float(np.median(np.abs(times - median)))
    return MEDIAN_FROM_MEAN * deviation <= SETTLED * median * math.sqrt(len(times))


def measure(
    render: Callable[[], Frame], repeats: int, max_repeats: int, before_clock: Callable[[], None] = lambda: None
) -> tuple[Frame, Timing]:
    """Render once to warm up, then `repeats` times, then on until the median settles or `max_repeats` is reached.

    `before_clock` is called once, after the warm-up. Times are those of the frames' own profiles, so nothing between the renders
    counts; garbage collection waits meanwhile.
    """
    frame = render()
    before_clock()
    profiles: list[Profile] = []
    collecting = gc.isenabled()
    gc.disable()
    try:
        while len(profiles) < repeats or (len(profiles) < max_repeats and not settled([profile.milliseconds for profile in profiles])):
            frame = render()
            profiles.append(frame.profile)
    finally:
        if collecting:
            gc.enable()
    return frame, summary(profiles)


def summary(profiles: Sequence[Profile]) -> Timing:
    """Medians over the repeats; bytes and counts are the last repeat's, as equal seeds do equal work."""
    times = [profile.milliseconds for profile in profiles]
    stages = {
        name: {
            "milliseconds": float(np.median([profile.stages[name].milliseconds for profile in profiles])),
            "bytes": int(stage.bytes),
            "counts": {key: int(count) for key, count in stage.counts.items()},
        }
        for name, stage in profiles[-1].stages.items()
    }
    return Timing(len(times), float(np.median(times)), float(np.percentile(times, 95)), stages)
