"""The user's cache folder: scenes, references and precomputations, each a file that may vanish at any time; studies of the tools.

    <folder>/<kind>/<name>        the folder is INTERREFLECT_CACHE, or the platform's folder for caches of users
    <folder>/studies/<name>/      what `attribute`, `ladder` and the like measured, which goes as a whole, but not while it runs

Files appear whole or not at all; the least recently used go first once all of them together pass MAX_BYTES.
"""

from __future__ import annotations

import os
import shutil
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from interreflect.study.files import DAMAGED, PART, remove_parts, replacing
from interreflect.study.locks import in_use

MAX_BYTES = 8 * 2**30


@dataclass(frozen=True)
class Entry:
    """A cached file, or a study's folder of so many: `used` is the time of its last use, seconds since 1970."""

    kind: str
    path: Path
    bytes: int
    used: float
    files: int = 1

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
    """Every cached file and study, damaged files that were set aside among them, the least recently used first."""
    found = []
    for path in folder().glob("*/*") if folder().is_dir() else ():
        if path.is_dir():
            found.append(_together(path))
        elif not path.name.endswith(PART):
            found += [Entry(path.parent.name, path, bytes_, used) for bytes_, used in _status(path)]
    return sorted(found, key=lambda entry: (entry.used, entry.path))


def _together(study: Path) -> Entry:
    """A folder as one entry, last used when any of its files was."""
    files = [status for path in study.rglob("*") if not path.is_dir() for status in _status(path)]
    return Entry(study.parent.name, study, sum(size for size, _ in files), max((used for _, used in files), default=0.0), len(files))


def _status(path: Path) -> list[tuple[int, float]]:
    """Bytes and time of last use; nothing of a file that another process has removed since."""
    with suppress(FileNotFoundError):
        status = path.stat()
        return [(status.st_size, status.st_mtime)]
    return []


def clear(kind: str | None = None) -> int:
    """Removes every file, or every one of a kind, but no study that runs; how many they were."""
    remove_parts(folder())
    return _remove([entry for entry in entries() if kind in (None, entry.kind) and not in_use(entry.path)])


def trim(limit: int = MAX_BYTES, keep: Path | None = None) -> int:
    """Removes damaged files and then the least recently used until `limit` bytes are left; how many they were."""
    found = entries()
    total, victims = sum(entry.bytes for entry in found), []
    for entry in sorted(found, key=lambda entry: not entry.path.name.endswith(DAMAGED)):
        if total > limit and entry.path != keep and not in_use(entry.path):
            victims.append(entry)
            total -= entry.bytes
    return _remove(victims)


def _remove(victims: list[Entry]) -> int:
    for entry in victims:
        if entry.path.is_dir():
            shutil.rmtree(entry.path, ignore_errors=True)
        else:
            entry.path.unlink(missing_ok=True)
    return sum(entry.files for entry in victims)


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
