"""Files as memory: their pages are read where they are needed, and need not stay in this process."""

from __future__ import annotations

import mmap
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np


class MappedFile(mmap.mmap):
    """The bytes of a file that nobody changes: it may be replaced or removed as a whole."""


def map_file(path: Path) -> MappedFile:
    """ValueError where the file is empty."""
    with path.open("rb") as file:
        return MappedFile(file.fileno(), 0, access=mmap.ACCESS_READ)


def let_go(arrays: Iterable[Any]) -> None:
    """Takes the pages of those arrays that lie in files out of this process's memory; whoever reads them gets them back."""
    files = {id(file): file for file in map(file_of, arrays) if file is not None}
    for file in files.values():
        file.madvise(mmap.MADV_DONTNEED)


def file_of(array: Any) -> MappedFile | None:
    """The file that holds the array, if one does."""
    base = array
    while isinstance(base, (np.ndarray, memoryview)):
        base = base.base if isinstance(base, np.ndarray) else base.obj
    return base if isinstance(base, MappedFile) else None
