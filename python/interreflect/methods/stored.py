"""Precomputations as files: what they belong to, their arrays and numbers, and a checksum over it all."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from interreflect.scenes.mapped import map_file
from interreflect.study.files import DamagedFile, replacing

KIND = b"interreflect precomputation "
VERSION = 2
MAGIC = KIND + b"%d\n" % VERSION
CHECK = 32  # bytes of the checksum, which follows the first line
ALIGN = 64


def write(path: Path, belongs: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    """belongs: plain values that say what the file was made from. values: arrays and plain numbers by name. The file appears whole."""
    arrays = {name: np.ascontiguousarray(value) for name, value in values.items() if isinstance(value, np.ndarray)}
    numbers = {name: value for name, value in values.items() if name not in arrays}
    listed = [[name, array.dtype.str, array.shape] for name, array in arrays.items()]
    head = json.dumps({"belongs": dict(belongs), "numbers": numbers, "arrays": listed}).encode()
    parts: list[bytes | memoryview] = [len(head).to_bytes(8, "little"), head]
    offset = len(MAGIC) + CHECK + 8 + len(head)
    for array in arrays.values():
        padding = bytes(-offset % ALIGN)
        parts += [padding, array.data.cast("B") if array.size else b""]
        offset += len(padding) + array.nbytes
    check = hashlib.blake2b(digest_size=CHECK)
    for part in parts:
        check.update(part)
    with replacing(path) as file:
        file.writelines([MAGIC, check.digest(), *parts])


def read(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """What `write` got. ValueError for a file of another kind or format, DamagedFile for one that is not as it was written."""
    data = map_file(path) if path.stat().st_size > 0 else b""
    if data[: len(KIND)] != KIND:
        raise ValueError(f"{path}: not a precomputation that was saved")
    if data[: len(MAGIC)] != MAGIC:
        found = bytes(data[len(KIND) : len(KIND) + 8]).partition(b"\n")[0].decode("ascii", "replace")
        raise ValueError(f"{path}: format version must be {VERSION}, got {found}")
    body = len(MAGIC) + CHECK
    if hashlib.blake2b(memoryview(data)[body:], digest_size=CHECK).digest() != data[len(MAGIC) : body]:
        raise DamagedFile(f"{path}: damaged or cut short: content and checksum differ")
    size = int.from_bytes(data[body : body + 8], "little")
    head = json.loads(data[body + 8 : body + 8 + size])
    offset, values = body + 8 + size, dict(head["numbers"])
    for name, dtype, shape in head["arrays"]:
        offset += -offset % ALIGN
        values[name] = np.frombuffer(data, dtype, int(np.prod(shape)), offset).reshape(shape)
        offset += values[name].nbytes
    return head["belongs"], values
