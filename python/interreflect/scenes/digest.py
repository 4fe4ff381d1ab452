"""Digests of content: values are equal where their digests are."""

from __future__ import annotations

import hashlib
import struct
from typing import Any

import numpy as np


def digest(*parts: Any) -> str:
    """blake2b of arrays, numbers, strings, None and tuples of them; each part carries its kind and length."""
    hasher = hashlib.blake2b(digest_size=16)
    for part in parts:
        _feed(hasher, part)
    return hasher.hexdigest()


def _feed(hasher: hashlib.blake2b, part: Any) -> None:
    if isinstance(part, np.ndarray):
        hasher.update(f"array {part.dtype.str} {part.shape} ".encode())
        hasher.update(np.ascontiguousarray(part).data.cast("B") if part.size else b"")
    elif isinstance(part, str):
        data = part.encode("utf-8", "surrogatepass")
        hasher.update(b"text %d " % len(data) + data)
    elif isinstance(part, bool) or part is None:
        hasher.update(f"{part} ".encode())
    elif isinstance(part, (int, float)):
        hasher.update(b"number" + struct.pack("<d", part + 0.0))
    elif isinstance(part, tuple):
        hasher.update(b"tuple %d " % len(part))
        for item in part:
            _feed(hasher, item)
    else:
        raise TypeError(f"no digest of a {type(part).__name__}")
