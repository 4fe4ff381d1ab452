"""The JSON of a glTF file: parsed within bounds, and read with every type checked.

Not by pygltflib (1.16, measured): it takes 300 times as long as Python's json (20,000 nodes: 29 s against 0.09), reads an object where
a list of nodes belongs as no nodes and lets NaN pass; what it refuses is a bare ValueError, AttributeError or TypeError without the key.
trimesh loses cameras and lights and loads cyclic nodes as an empty scene.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from interreflect.errors import SceneError
from interreflect.scenes.checks import FLOAT_MAX, shorten

MAX_JSON_BYTES = 2**28
MAX_DEPTH = 64

_HALF_CHARACTER = re.compile("[\ud800-\udfff]")  # what JSON can spell and no file or terminal can hold
# A string, also one without an end: it never gives back what it took, so that no text costs more than one pass
_STRING = re.compile(rb'"(?:[^"\\]++|\\.|\\\Z)*+(?:"|\Z)', re.DOTALL)


def parse_json(file: str, data: bytes) -> Table:
    """The outermost object. SceneError for what is no JSON, for nesting beyond 64, NaN and Infinity."""
    if len(data) > MAX_JSON_BYTES:
        raise SceneError(f"{file}: {len(data)} bytes of JSON are more than the {MAX_JSON_BYTES} that are read")
    letters = np.frombuffer(_STRING.sub(b"", data), np.uint8)
    opened = np.isin(letters, list(b"[{")).astype(np.int32) - np.isin(letters, list(b"]}"))
    depth = int(np.cumsum(opened).max(initial=0))
    if depth > MAX_DEPTH:
        raise SceneError(f"{file}: JSON nested {depth} deep is more than the {MAX_DEPTH} that are read")

    def refuse(constant: str) -> float:
        raise ValueError(f"{constant} is no number of JSON")

    try:
        value = json.loads(data.decode("utf-8"), parse_constant=refuse)
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{file}: is no JSON: {str(error)[:200]}") from None
    if not isinstance(value, dict):
        raise SceneError(f"{file}: must hold an object, got {type(value).__name__}")
    return Table(file, "", value)


@dataclass(frozen=True)
class Table:
    """A JSON object and where it stands, so that every message names file and key."""

    file: str
    path: str
    value: dict[str, Any]

    @property
    def where(self) -> str:
        return f"{self.file}: {self.path[:-1]}"

    def error(self, key: str, message: str) -> SceneError:
        return SceneError(f"{self.file}: {self.path}{key} {message}" if key else f"{self.where} {message}")

    def __contains__(self, key: str) -> bool:
        return key in self.value

    def _get(self, key: str, default: Any) -> Any:
        if key not in self.value:
            if default is ...:
                raise self.error(key, "is missing")
            return default
        return self.value[key]

    def table(self, key: str) -> Table:
        """The object at `key`, empty where absent."""
        value = self._get(key, {})
        if not isinstance(value, dict):
            raise self.error(key, f"must be an object, got {shorten(value)}")
        return Table(self.file, f"{self.path}{key}.", value)

    def tables(self, key: str) -> list[Table]:
        """The list of objects at `key`, empty where absent."""
        value = self._get(key, [])
        if not isinstance(value, list):
            raise self.error(key, f"must be a list, got {shorten(value)}")
        for k, item in enumerate(value):
            if not isinstance(item, dict):
                raise self.error(f"{key}[{k}]", f"must be an object, got {shorten(item)}")
        return [Table(self.file, f"{self.path}{key}[{k}].", item) for k, item in enumerate(value)]

    def text(self, key: str, default: Any = ...) -> str:
        value = self._get(key, default)
        if not isinstance(value, str) or _HALF_CHARACTER.search(value):
            raise self.error(key, f"must be a string, got {shorten(value)}")
        return value

    def texts(self, key: str) -> list[str]:
        value = self._get(key, [])
        if not isinstance(value, list) or not all(isinstance(x, str) for x in value):
            raise self.error(key, f"must be a list of strings, got {shorten(value)}")
        return value

    def whole(self, key: str, bound: int, default: Any = ...) -> int:
        """A whole number in [0, bound)."""
        value = self._get(key, default)
        if not isinstance(value, int) or isinstance(value, bool) or not 0 <= value < bound:
            raise self.error(key, f"must be a whole number in [0, {bound}), got {shorten(value)}")
        return value

    def wholes(self, key: str, bound: int) -> list[int]:
        value = self._get(key, [])
        if not isinstance(value, list) or not all(isinstance(x, int) and not isinstance(x, bool) and 0 <= x < bound for x in value):
            raise self.error(key, f"must be a list of whole numbers in [0, {bound}), got {shorten(value)}")
        return value

    def number(self, key: str, default: Any = ..., low: float = -FLOAT_MAX, high: float = FLOAT_MAX) -> float:
        value = self._get(key, default)
        if not isinstance(value, (int, float)) or isinstance(value, bool) or not low <= value <= high or not math.isfinite(value):
            raise self.error(key, f"must be a finite number in [{low:g}, {high:g}], got {shorten(value)}")
        return float(value)

    def numbers(self, key: str, count: int, default: Any = ..., low: float = -FLOAT_MAX, high: float = FLOAT_MAX) -> list[float]:
        value = self._get(key, default)
        good = isinstance(value, (list, tuple)) and len(value) == count
        if not good or not all(isinstance(x, (int, float)) and not isinstance(x, bool) and low <= x <= high for x in value):
            raise self.error(key, f"must be {count} finite numbers in [{low:g}, {high:g}], got {shorten(value)}")
        return [float(x) for x in value]
