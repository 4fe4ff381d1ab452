"""Stanford .ply, ASCII and binary. Sizes are checked against the file before anything is allocated.

Read here rather than by trimesh (5.2, measured): it refuses sound binary files ("unexpected length") whose faces have different
numbers of corners or that end in a newline, and reads an ASCII body on one line, or cut short, as an empty mesh. Indices out of range
and infinity pass, 1.5 becomes index 1. Tests compare the triangles with its.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.checks import shorten
from interreflect.scenes.files import MAX_GEOMETRY_BYTES, read_bytes, shown
from interreflect.scenes.obj_text import parsed, word_begins
from interreflect.scenes.parts import GeometryFile, Placed, checked_part, fans

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2", "uint16": "u2",
    "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
_CODES = {"i1": "b", "u1": "B", "i2": "h", "u2": "H", "i4": "i", "u4": "I", "f8": "d"}
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_MAX_HEADER = 2**16
_INDICES = ("vertex_indices", "vertex_index")
_TEXCOORDS = (("u", "v"), ("s", "t"), ("texture_u", "texture_v"))


@dataclass
class Property:
    """A column of an element: `count` is the type of a list's length, None for a single number."""

    name: str
    kind: str
    count: str | None


@dataclass
class Element:
    name: str
    rows: int
    properties: list[Property]


@dataclass
class Lists:
    """Rows of different lengths, one behind the other."""

    values: NDArray[Any]
    lengths: NDArray[np.int64]


Columns = dict[str, NDArray[Any] | Lists]
Whole = NDArray[np.int64]


def read_ply(path: str) -> GeometryFile:
    """One part; polygons become fans. Colours and other properties are ignored."""
    file = shown(path)
    data = read_bytes(path, MAX_GEOMETRY_BYTES)
    order, elements, body = _header(file, data)
    columns = _ascii(file, data[body:], elements) if order == "" else _binary(file, data, body, order, elements)
    if "vertex" not in columns or "face" not in columns:
        raise SceneError(f"{file}: lacks element {'face' if 'vertex' in columns else 'vertex'!r}")
    vertices = columns["vertex"]
    positions = _stacked(vertices, "xyz")
    if positions is None:
        raise SceneError(f"{file}: vertices lack x, y and z")
    indices = next((columns["face"][name] for name in _INDICES if name in columns["face"]), None)
    if not isinstance(indices, Lists):
        raise SceneError(f"{file}: faces lack the list vertex_indices")
    texcoords = next((pair for names in _TEXCOORDS if (pair := _stacked(vertices, names)) is not None), None)
    part = checked_part(file, positions, _triangles(file, indices), _stacked(vertices, ("nx", "ny", "nz")), texcoords)
    return GeometryFile([part], [Placed(0)])


def _header(file: str, data: bytes) -> tuple[str, list[Element], int]:
    """Byte order ("" for ASCII), elements, and where the body begins."""
    end = data.find(b"end_header", 0, _MAX_HEADER)
    body = data.find(b"\n", end, end + 12) + 1
    if not data.startswith(b"ply") or end < 0 or body == 0:
        raise SceneError(f"{file}: is no .ply: it must begin with 'ply' and have 'end_header' within {_MAX_HEADER} bytes")
    order, elements = None, []
    for number, raw in enumerate(data[:end].decode("latin-1").splitlines(), 1):
        words = raw.split()
        if not words or words[0] in ("ply", "comment", "obj_info"):
            continue
        try:
            if words[0] == "format" and order is None:
                order = _FORMATS[words[1]]
            elif words[0] == "element" and words[2].isdecimal() and len(words[2]) < 16:
                elements.append(Element(words[1], int(words[2]), []))
            elif words[0] == "property" and words[1] == "list":
                elements[-1].properties.append(Property(words[4], _TYPES[words[3]], _TYPES[words[2]]))
            elif words[0] == "property":
                elements[-1].properties.append(Property(words[2], _TYPES[words[1]], None))
            else:
                raise KeyError
        except (KeyError, IndexError):
            raise SceneError(f"{file}:{number}: no line of a .ply's header, got {shorten(raw)}") from None
    if order is None:
        raise SceneError(f"{file}: lacks its format")
    for element in elements:
        names = [p.name for p in element.properties]
        if len(set(names)) < len(names) or not names:
            raise SceneError(f"{file}: element {shorten(element.name)} must have properties with distinct names")
        if any(p.count is not None and p.count[0] == "f" for p in element.properties):
            raise SceneError(f"{file}: element {shorten(element.name)}: the length of a list must be a whole number")
    return order, elements, body


def _binary(file: str, data: bytes, at: int, order: str, elements: Sequence[Element]) -> dict[str, Columns]:
    result: dict[str, Columns] = {}
    for element in elements:
        single = all(p.count is None for p in element.properties)
        columns, at = (_rows if single else _rows_with_lists)(file, data, at, order, element)
        result.setdefault(element.name, columns)
    return result


def _too_short(file: str, element: Element) -> SceneError:
    return SceneError(f"{file}: ends before the {element.rows} rows of element {shorten(element.name)}")


def _rows(file: str, data: bytes, at: int, order: str, element: Element) -> tuple[Columns, int]:
    dtype = np.dtype([(p.name, order + p.kind) for p in element.properties])
    end = at + dtype.itemsize * element.rows
    if end > len(data):
        raise _too_short(file, element)
    table = np.frombuffer(data, dtype, element.rows, at)
    return {p.name: table[p.name] for p in element.properties}, end


def _rows_with_lists(file: str, data: bytes, at: int, order: str, element: Element) -> tuple[Columns, int]:
    """In one step where all rows have lists as long as the first row's, else row by row."""
    least = sum(np.dtype(p.count or p.kind).itemsize for p in element.properties)
    if at + least * element.rows > len(data):
        raise _too_short(file, element)
    offsets, lengths, end = _walked(file, data, at, order, element, min(element.rows, 1))
    if element.rows and at + (end - at) * element.rows <= len(data):
        rows = np.frombuffer(data, np.uint8, (end - at) * element.rows, at).reshape(element.rows, end - at)
        heads = [(p, offsets[k][0] - at) for k, p in enumerate(element.properties) if p.count is not None]
        spans = [slice(offset - np.dtype(p.count).itemsize, offset) for p, offset in heads]
        if all((rows[:, span] == rows[:1, span]).all() for span in spans):
            steps = np.arange(element.rows) * (end - at)
            offsets, lengths = [steps + o[0] for o in offsets], [np.full(element.rows, n[0]) for n in lengths]
            return _gathered(data, order, element, offsets, lengths), at + (end - at) * element.rows
    offsets, lengths, end = _walked(file, data, at, order, element, element.rows)
    return _gathered(data, order, element, offsets, lengths), end


def _walked(file: str, data: bytes, at: int, order: str, element: Element, rows: int) -> tuple[list[Whole], list[Whole], int]:
    """Where the numbers of each property begin and how many they are, for each of the first rows; where those rows end."""
    steps = [
        (struct.Struct((order or "=") + _CODES[p.count]) if p.count is not None else None, np.dtype(p.kind).itemsize)
        for p in element.properties
    ]
    offsets: list[list[int]] = [[] for _ in steps]
    lengths: list[list[int]] = [[] for _ in steps]
    size = len(data)
    for _ in range(rows):
        for k, (count, width) in enumerate(steps):
            length = 1
            if count is not None:
                if at + count.size > size:
                    raise _too_short(file, element)
                (given,) = count.unpack_from(data, at)
                at += count.size
                if not 0 <= given <= size or given != int(given):
                    raise SceneError(f"{file}: a list of element {shorten(element.name)} cannot have length {given}")
                length = int(given)
            offsets[k].append(at)
            lengths[k].append(length)
            at += width * length
        if at > size:
            raise _too_short(file, element)
    return [np.array(o, np.int64) for o in offsets], [np.array(n, np.int64) for n in lengths], at


def _gathered(data: bytes, order: str, element: Element, offsets: list[Whole], lengths: list[Whole]) -> Columns:
    letters = np.frombuffer(data, np.uint8)
    columns: Columns = {}
    for p, offset, length in zip(element.properties, offsets, lengths, strict=True):
        kind = np.dtype(order + p.kind)
        inside = np.arange(int(length.sum())) - np.repeat(np.cumsum(length) - length, length)
        begins = np.repeat(offset, length) + inside * kind.itemsize
        values = letters[begins[:, None] + np.arange(kind.itemsize)].reshape(-1).view(kind)
        columns[p.name] = values if p.count is None else Lists(values, length)
    return columns


def _ascii(file: str, text: bytes, elements: Sequence[Element]) -> dict[str, Columns]:
    """The body is numbers separated by white space: the same rows as a binary body's, every number a double."""
    words = word_begins(np.frombuffer(text, np.uint8) > ord(" "))
    values = parsed(text, np.float64, len(words))
    if values is None:
        raise SceneError(f"{file}: the body must be numbers")
    doubles = [Element(e.name, e.rows, [Property(p.name, "f8", None if p.count is None else "f8") for p in e.properties]) for e in elements]
    return _binary(file, values.tobytes(), 0, "", doubles)


def _stacked(columns: Columns, names: Sequence[str]) -> NDArray[np.float64] | None:
    arrays = [columns.get(name) for name in names]
    if not all(isinstance(array, np.ndarray) for array in arrays):
        return None
    return np.stack([np.asarray(array, np.float64) for array in arrays], 1)


def _triangles(file: str, indices: Lists) -> NDArray[np.int64]:
    """(m, 3) indices; faces of fewer than three corners are refused."""
    lengths, values = indices.lengths, indices.values
    if len(lengths) and lengths.min() < 3:
        raise SceneError(f"{file}: face {int(np.argmin(lengths))} must have at least three corners, got {int(lengths.min())}")
    if values.dtype.kind == "f" and not ((np.abs(values) < 2**53) & (values == np.floor(values))).all():
        raise SceneError(f"{file}: vertex indices must be whole numbers")
    return values.astype(np.int64)[fans(lengths)]
