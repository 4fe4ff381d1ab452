"""The user's cache folder: scenes, references and precomputations, each a file that may vanish at any time.

    <folder>/<kind>/<name>        the folder is INTERREFLECT_CACHE, or the platform's folder for caches of users

Files appear whole or not at all; the least recently used go first once all of them together pass MAX_BYTES.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from interreflect.study.files import DAMAGED, PART, remove_parts, replacing

MAX_BYTES = 8 * 2**30


@dataclass(frozen=True)
class Entry:
    """A cached file: `used` is the time of its last use, seconds since 1970."""

    kind: str
    path: Path
    bytes: int
    used: float

    @property
    def key(self) -> str:
        return self.path.name


def folder(kind: str | None = None) -> Path:
    """The cache folder, or where files of one kind lie in it ("scenes", "references", ...); it need not exist."""
    given = os.environ.get("INTERREFLECT_CACHE")
    if given:
        whole = Path(given)
    else:
        from platformdirs import user_cache_path

        whole = user_cache_path("interreflect")
    return whole / kind if kind else whole


def entries() -> list[Entry]:
    """Every cached file, damaged ones that were set aside among them, the least recently used first."""
    found = []
    for path in folder().glob("*/*") if folder().is_dir() else ():
        with suppress(FileNotFoundError):  # another process may have removed it since
            status = path.stat()
            if path.is_file() and not path.name.endswith(PART):
                found.append(Entry(path.parent.name, path, status.st_size, status.st_mtime))
    return sorted(found, key=lambda entry: (entry.used, entry.path))


def clear(kind: str | None = None) -> int:
    """Removes every file, or every one of a kind; how many they were."""
    remove_parts(folder())
    return _remove([entry for entry in entries() if kind in (None, entry.kind)])


def trim(limit: int = MAX_BYTES, keep: Path | None = None) -> int:
    """Removes damaged files and then the least recently used until `limit` bytes are left; how many they were."""
    found = entries()
    total, victims = sum(entry.bytes for entry in found), []
    for entry in sorted(found, key=lambda entry: not entry.path.name.endswith(DAMAGED)):
        if total > limit and entry.path != keep:
            victims.append(entry)
            total -= entry.bytes
    return _remove(victims)


def _remove(victims: list[Entry]) -> int:
    for entry in victims:
        entry.path.unlink(missing_ok=True)
    return len(victims)


def touch(path: Path) -> None:
    """Marks a file as used now, so that it outlives those that are not."""
    with suppress(OSError):  # a cache that cannot be written can still be read
        os.utime(path)


def write(path: Path, fill: Callable[[IO[bytes]], object]) -> bool:
    """A file that appears under `path` once `fill(file)` has written it whole; then the cache is trimmed.

    Where the folder cannot be written, a warning says so and the answer is False: the work goes on without a cache.
    """
    try:
        with replacing(path, sync=False) as file:  # unsynced: whoever reads a cached file checks it
            fill(file)
        trim(keep=path)
    except OSError as error:
        warnings.warn(f"cache folder {folder()} cannot be written: {error.strerror}", RuntimeWarning, stacklevel=2)
        return False
    return True
