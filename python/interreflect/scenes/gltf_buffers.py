"""Buffers, accessors and images of a glTF file: bounds checked before anything is read.

pygltflib (1.16, measured) opens a .glb whose version is 9 or whose chunk is longer than the file, returns None for one without JSON,
and leaves accessors, strides and bounds to its caller.
"""

from __future__ import annotations

import base64
import binascii
import struct
from typing import Any
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.files import MAX_GEOMETRY_BYTES, Folder, read_bytes
from interreflect.scenes.gltf_json import Table

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
MAX_ROWS = 2**26
_JSON_CHUNK, _BINARY_CHUNK = 0x4E4F534A, 0x004E4942


def split_glb(file: str, data: bytes) -> tuple[bytes, bytes | None]:
    """JSON and binary chunk of a .glb."""
    if len(data) < 12 or data[:4] != b"glTF":
        raise SceneError(f"{file}: is no .glb: it must begin with 'glTF'")
    version, length = struct.unpack_from("<II", data, 4)
    if version != 2 or length > len(data):
        raise SceneError(f"{file}: must be version 2 and {length} bytes long, got version {version} and {len(data)} bytes")
    chunks: dict[int, bytes] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        if at + 8 + size > length:
            raise SceneError(f"{file}: chunk of {size} bytes does not fit into the file")
        chunks.setdefault(kind, data[at + 8 : at + 8 + size])
        at += 8 + size
    if _JSON_CHUNK not in chunks:
        raise SceneError(f"{file}: lacks its JSON chunk")
    return chunks[_JSON_CHUNK], chunks.get(_BINARY_CHUNK)


class Buffers:
    """Reads accessors; each buffer and each accessor once."""

    def __init__(self, root: Table, path: str, folder: Folder, binary: bytes | None) -> None:
        self._path, self._folder, self._binary = path, folder, binary
        self._buffers, self._views, self._accessors = (root.tables(key) for key in ("buffers", "bufferViews", "accessors"))
        self._loaded: dict[int, bytes] = {}
        self._read: dict[int, NDArray[Any]] = {}
        self._rows = 0

    def count_rows(self, table: Table, rows: int) -> None:
        """SceneError where the file's primitives together have too many vertices and triangles, as accessors may be named again."""
        self._rows += rows
        if self._rows > MAX_ROWS:
            raise table.error("", f"makes more than the {MAX_ROWS} vertices and triangles that are read")

    def _buffer(self, k: int) -> bytes:
        if k not in self._loaded:
            table = self._buffers[k]
            length = table.whole("byteLength", MAX_GEOMETRY_BYTES)
            if "uri" in table:
                data = self._uri(table)
            elif k == 0 and self._binary is not None:
                data = self._binary
            else:
                raise table.error("uri", "is missing")
            if len(data) < length:
                raise table.error("byteLength", f"must be at most the {len(data)} bytes that there are, got {length}")
            self._loaded[k] = data[:length]
        return self._loaded[k]

    def _uri(self, table: Table) -> bytes:
        uri = table.text("uri")
        if uri.startswith("data:"):
            return embedded(table, uri)
        where = f"{table.file}: {table.path}uri"
        return read_bytes(self._folder.require(unquote(uri), where, self._path), MAX_GEOMETRY_BYTES)

    def view(self, k: int) -> tuple[bytes, int, int, int | None]:
        """Buffer, offset, length and stride of a buffer view."""
        table = self._views[k]
        data = self._buffer(table.whole("buffer", len(self._buffers)))
        offset = table.whole("byteOffset", len(data) + 1, 0)
        length = table.whole("byteLength", len(data) - offset + 1)
        return data, offset, length, table.whole("byteStride", 253, 0) or None

    def view_bytes(self, table: Table, key: str) -> bytes:
        data, offset, length, _ = self.view(table.whole(key, len(self._views)))
        return data[offset : offset + length]

    def array(self, table: Table, key: str, kind: str) -> NDArray[Any]:
        """(count, width) numbers of the accessor that `table` names at `key`; normalised integers become float."""
        k = table.whole(key, len(self._accessors))
        if k not in self._read:
            self._read[k] = self._accessor(self._accessors[k])
        width = _WIDTHS[kind]
        if self._read[k].shape[1] != width:
            raise table.error(key, f"must be the number of an accessor of type {kind}")
        return self._read[k]

    def _accessor(self, table: Table) -> NDArray[Any]:
        if "sparse" in table or "bufferView" not in table:
            raise table.error("bufferView", "is missing or sparse, which is not read")
        component, kind = table.whole("componentType", 2**16), table.text("type")
        if component not in _COMPONENTS or kind not in _WIDTHS:
            raise table.error("type", f"must be a known one, got {kind[:20]!r} of components {component}")
        dtype, width = np.dtype(_COMPONENTS[component]), _WIDTHS[kind]
        data, begin, length, given_stride = self.view(table.whole("bufferView", len(self._views)))
        row = dtype.itemsize * width
        stride = given_stride or row
        offset = table.whole("byteOffset", length + 1, 0)
        count = table.whole("count", 2**32)
        if stride < row or (count and offset + stride * (count - 1) + row > length):
            raise table.error("count", f"of {count} rows of {row} bytes does not fit into its buffer view of {length} bytes")
        rows = np.ndarray((count, width), dtype, data, begin + offset, (stride, dtype.itemsize)) if count else np.zeros((0, width), dtype)
        if table.value.get("normalized") is True and dtype.kind in "iu":
            return np.maximum(rows / np.float32(np.iinfo(dtype).max), np.float32(-1))
        return rows


def embedded(table: Table, uri: str) -> bytes:
    """The bytes of a data: URI in base64."""
    head, comma, body = uri.partition(",")
    if not comma or not head.endswith(";base64"):
        raise table.error("uri", "must be a file or data in base64")
    try:
        return base64.b64decode(body, validate=True)
    except (binascii.Error, ValueError):
        raise table.error("uri", "must be a file or data in base64") from None
