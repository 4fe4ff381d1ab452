"""Least times of works that take turns, so that whatever else the machine does meets all of them alike."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable

Work = Callable[[], float]


def timed(call: Callable[[], object]) -> Work:
    """A work whose milliseconds are the wall time of `call`."""

    def work() -> float:
        start = time.perf_counter()
        call()
        return 1e3 * (time.perf_counter() - start)

    return work


def least(*works: Work, repeats: int) -> list[float]:
    """Least milliseconds of each work (they return theirs), in turn, after a warm-up of each."""
    for work in works:
        work()
    gc.collect()
    gc.disable()
    try:
        turns = [[work() for work in works] for _ in range(repeats)]
    finally:
        gc.enable()
    return [min(times) for times in zip(*turns, strict=True)]
