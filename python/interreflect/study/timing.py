"""How long does a frame take? A warm-up, then repeats until their median is known, on a machine that does nothing else."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from interreflect.study.contention import Watch
from interreflect.study.interface import Frame, Profile
from interreflect.study.memory import without_collection
from interreflect.study.uncertainty import median_interval

WITHIN = 0.02  # of the median: how near both ends of its interval must be


@dataclasses.dataclass(frozen=True)
class Timing:
    """Milliseconds of the repeats: each, their median with its 95 % interval, their 95th percentile, the median of each stage.

    NaN where nothing was timed, and for the interval of fewer than six repeats. others_share, contended: see Contention.
    """

    repeats: int
    times: tuple[float, ...]
    milliseconds: float
    milliseconds_low: float
    milliseconds_high: float
    milliseconds_p95: float
    others_share: float
    contended: bool
    stages: dict[str, dict[str, Any]]  # name -> milliseconds, bytes, counts


def settled(times: Sequence[float]) -> bool:
    """Is the median known to 2 %?"""
    low, high = median_interval(times)
    median = float(np.median(times))
    return max(high - median, median - low) <= WITHIN * median  # not if they are NaN


def measure(
    render: Callable[[], Frame], repeats: int, max_repeats: int, before_clock: Callable[[], None] = lambda: None
) -> tuple[Frame, Timing]:
    """Render once to warm up, then `repeats` times, then on until the median settles or `max_repeats` is reached; 0 repeats: no more.

    Where others used the processors meanwhile all repeats are made once more, and the quieter ones count. `before_clock` is called
    once, after the warm-up. Times are those of the frames' own profiles, so nothing between the renders counts; garbage collection
    waits meanwhile.
    """
    frame = render()
    if repeats == 0:
        return frame, untimed(frame.profile)
    before_clock()
    with without_collection():
        frame, timing = _repeat(render, repeats, max_repeats)
        if timing.contended:
            frame, again = _repeat(render, repeats, max_repeats)
            timing = min(timing, again, key=lambda timing: timing.others_share)
    return frame, timing


def _repeat(render: Callable[[], Frame], repeats: int, max_repeats: int) -> tuple[Frame, Timing]:
    watch, profiles = Watch(), list[Profile]()
    while len(profiles) < repeats or (len(profiles) < max_repeats and not settled([profile.milliseconds for profile in profiles])):
        frame = render()
        profiles.append(frame.profile)
    return frame, summary(profiles, watch)


def summary(profiles: Sequence[Profile], watch: Watch) -> Timing:
    """Medians over the repeats; bytes and counts are the last repeat's, as equal seeds do equal work."""
    times = tuple(float(profile.milliseconds) for profile in profiles)
    contention = watch.contention()
    low, high = median_interval(times)
    return Timing(
        repeats=len(times),
        times=times,
        milliseconds=float(np.median(times)),
        milliseconds_low=low,
        milliseconds_high=high,
        milliseconds_p95=float(np.percentile(times, 95)),
        others_share=contention.others_share,
        contended=contention.contended,
        stages=_stages(profiles[-1], lambda name: float(np.median([profile.stages[name].milliseconds for profile in profiles]))),
    )


def untimed(profile: Profile) -> Timing:
    """What is known of a frame without its times: the bytes and the work of its stages."""
    return Timing(0, (), math.nan, math.nan, math.nan, math.nan, math.nan, False, _stages(profile, lambda _: math.nan))


def _stages(profile: Profile, milliseconds: Callable[[str], float]) -> dict[str, dict[str, Any]]:
    return {
        name: {
            "milliseconds": milliseconds(name),
            "bytes": int(stage.bytes),
            "counts": {key: int(count) for key, count in stage.counts.items()},
        }
        for name, stage in profile.stages.items()
    }
