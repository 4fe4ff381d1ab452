"""Who else used the processors while something was timed? By the kernel's own counts (Linux)."""

from __future__ import annotations

import dataclasses
import itertools
import os
import resource
import time
from contextlib import suppress

from interreflect.study.memory import read

TICK = 1 / os.sysconf("SC_CLK_TCK")  # seconds: the grain of /proc/stat
BUSY = (1, 2, 3, 6, 7, 8)  # of a line of /proc/stat: user, nice, system, irq, softirq, steal (another machine's share of a virtual one)
TOLERATED_SHARE = 0.05  # of the processors, taken by others: system services of an idle machine stay below
TOLERATED_WAIT = 0.02  # of the time: as well as medians are to be known


@dataclasses.dataclass(frozen=True)
class Contention:
    """others_share: of the processors that this process may use, 0 to 1; contended: enough to disturb its times."""

    others_share: float
    contended: bool


class Watch:
    """Made when something begins; `contention()` tells of the time since."""

    def __init__(self) -> None:
        self._start = _reading()

    def contention(self) -> Contention:
        """Who else used the processors, and how long this process's threads stood ready without one.

        The share has a grain of a tick, 10 ms: in shorter times than fifty of them it takes more than TOLERATED_SHARE to be sure.
        """
        elapsed, busy, own, waited = (now - then for now, then in zip(_reading(), self._start, strict=True))
        processors = len(os.sched_getaffinity(0))
        share = min(max((busy - own) / (elapsed * processors), 0.0), 1.0)
        surely = share - TICK / elapsed > TOLERATED_SHARE
        # Waiting alone may be this process's own doing, with more threads than processors.
        return Contention(share, surely or (waited / elapsed > TOLERATED_WAIT and share > TOLERATED_WAIT))


def _reading() -> tuple[float, float, float, float]:
    """Seconds: of the clock, of work of anybody on our processors, of our own work, of our threads' waiting for a processor."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return time.perf_counter(), _busy_seconds(), used.ru_utime + used.ru_stime, _waited_seconds()


def _busy_seconds() -> float:
    ours = {b"cpu%d" % number for number in os.sched_getaffinity(0)}
    lines = itertools.takewhile(lambda line: line.startswith(b"cpu"), read("/proc/stat").splitlines())
    processors = [fields for line in lines if (fields := line.split())[0] in ours]
    return TICK * sum(int(fields[index]) for fields in processors for index in BUSY)


def _waited_seconds() -> float:
    """0 where the kernel does not count it (/proc/<pid>/schedstat)."""
    waited = 0
    for thread in os.listdir("/proc/self/task"):
        with suppress(OSError, IndexError):  # a thread that has ended meanwhile
            waited += int(read(f"/proc/self/task/{thread}/schedstat").split()[1])
    return waited * 1e-9
