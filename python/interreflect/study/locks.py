"""Who may do what now: cells of a folder that a run has claimed, and the machine, which a timed cell has for itself.

Locks belong to an open file, so the kernel frees them when their process ends, however it ends.
"""

from __future__ import annotations

import fcntl
import os
import struct
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

LOCK = struct.Struct("hhqqi")  # struct flock, x86-64 and AArch64 Linux: type, whence, start, length, process


class Claims:
    """What this run makes of a folder's content: bytes of the file `claims` there, locked one by one, so that runs share the work."""

    def __init__(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._file = os.open(folder / "claims", os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)

    def take(self, key: str) -> bool:
        """Claim what a key (hexadecimal) names; False where another run has it."""
        try:
            self._lock(fcntl.F_OFD_SETLK, fcntl.F_WRLCK, key)
        except (BlockingIOError, PermissionError):
            return False
        return True

    def wait_for(self, key: str) -> None:
        """Claim it as soon as no other run has it."""
        self._lock(fcntl.F_OFD_SETLKW, fcntl.F_WRLCK, key)

    def leave(self, key: str) -> None:
        self._lock(fcntl.F_OFD_SETLK, fcntl.F_UNLCK, key)

    def close(self) -> None:
        os.close(self._file)

    def _lock(self, command: int, kind: int, key: str) -> None:
        place = int(key[:15], 16)  # below 2^60: two keys of one place wait for each other, no worse
        fcntl.fcntl(self._file, command, LOCK.pack(kind, os.SEEK_SET, place, 1, 0))


def in_use(folder: Path) -> bool:
    """Does a run measure into this folder now?"""
    try:
        file = os.open(folder / "claims", os.O_RDONLY | os.O_CLOEXEC)
    except OSError:
        return False
    try:
        all_of_it = LOCK.pack(fcntl.F_WRLCK, os.SEEK_SET, 0, 0, 0)
        kind, *_ = LOCK.unpack(fcntl.fcntl(file, fcntl.F_OFD_GETLK, all_of_it))
    finally:
        os.close(file)
    return bool(kind != fcntl.F_UNLCK)


@contextmanager
def machine(alone: bool, waiting: Callable[[], None] = lambda: None) -> Iterator[None]:
    """The machine for what is timed (`alone`), or together with others that are not; `waiting` is called before a wait.

    Two locks: everybody passes the gate, so that who wants to be alone is not kept waiting by those who come later.
    """
    gate, room = _open("gate"), _open("room")
    try:
        _wait(gate, fcntl.LOCK_EX, waiting)
        _wait(room, fcntl.LOCK_EX if alone else fcntl.LOCK_SH, waiting)
        fcntl.flock(gate, fcntl.LOCK_UN)
        yield
    finally:
        os.close(gate)
        os.close(room)


def _wait(file: int, kind: int, waiting: Callable[[], None]) -> None:
    try:
        fcntl.flock(file, kind | fcntl.LOCK_NB)
    except BlockingIOError:
        waiting()
        fcntl.flock(file, kind)


def _open(name: str) -> int:
    """A file that every user may lock, whoever made it: in INTERREFLECT_LOCKS, else the machine's temporary folder."""
    path = Path(os.environ.get("INTERREFLECT_LOCKS") or tempfile.gettempdir()) / f"interreflect-{name}.lock"
    flags = os.O_RDONLY | os.O_CLOEXEC | os.O_NOFOLLOW
    try:
        return os.open(path, flags)
    except FileNotFoundError:
        return os.open(path, flags | os.O_CREAT, 0o644)
