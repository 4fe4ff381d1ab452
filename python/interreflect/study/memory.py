"""How much memory this process holds, by the kernel's count (Linux)."""

from __future__ import annotations

import ctypes
import gc
import math
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

PAGE = os.sysconf("SC_PAGE_SIZE")
RESET_PEAK = "5"  # proc(5), /proc/[pid]/clear_refs
PEAK = re.compile(rb"^VmHWM:\s*(\d+) kB$", re.MULTILINE)
CHUNK = 2**16  # bytes; most of the kernel's files are shorter


def read(path: str) -> bytes:
    """What the kernel says in a file of its own; three calls, where `open` makes eight."""
    file = os.open(path, os.O_RDONLY | os.O_CLOEXEC)
    try:
        return b"".join(iter(lambda: os.read(file, CHUNK), b""))
    finally:
        os.close(file)


def resident_bytes(process: int | str = "self") -> int:
    """Bytes of physical memory that a process holds now; 0 for one that is gone."""
    try:
        return int(read(f"/proc/{process}/statm").split()[1]) * PAGE
    except (OSError, IndexError):
        return 0


def reset_peak() -> bool:
    """Let the peak start anew from what is held now; False where the kernel does not permit it."""
    try:
        Path("/proc/self/clear_refs").write_text(RESET_PEAK)
    except OSError:
        return False
    return True


def peak_bytes() -> float:
    """The largest resident size since `reset_peak`; NaN where the kernel does not say."""
    try:
        found = PEAK.search(read("/proc/self/status"))
    except OSError:
        return math.nan
    return int(found.group(1)) * 1024.0 if found else math.nan


@contextmanager
def without_collection() -> Iterator[None]:
    """Let the collection of cyclic garbage wait."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()


def give_back() -> None:
    """Return what is free to the system, so that one cell's memory is not counted with the next one's."""
    gc.collect()
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)  # glibc only
