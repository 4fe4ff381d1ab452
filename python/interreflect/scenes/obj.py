"""Wavefront .obj.

Read here rather than by trimesh (5.2, measured): index 0 wraps to the last vertex, infinity passes, `v 0 0` gives points in a plane
and `f 1 2` an empty mesh, all without a word; what it does refuse it names without file and line. It merges equal positions where a
file has no vt and vn, and drops the attributes of a whole group for one mixed corner. Tests compare the triangles with its.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.files import MAX_GEOMETRY_BYTES, Folder, read_bytes, shown
from interreflect.scenes.mtl import read_mtl
from interreflect.scenes.obj_text import Corners, Integers, Lines, face_corners, normalised, number_table
from interreflect.scenes.parts import GeometryFile, Part, Placed, fans

_NUMBERS = ("v", "vt", "vn")
_FREE_FORM = frozenset({"vp", "cstype", "deg", "bmat", "step", "curv", "curv2", "surf", "parm", "trim", "hole", "scrv", "sp", "end", "con"})
_IGNORED = frozenset(
    ["g", "o", "s", "mg", "l", "p", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech", "stech", "maplib", "usemap"]
)


def read_obj(path: str, folder: Folder) -> GeometryFile:
    """Parts, one for each material and each set of attributes that its corners have; polygons become fans."""
    file = shown(path)
    lines = Lines.of(file, normalised(read_bytes(path, MAX_GEOMETRY_BYTES)))
    tables = [number_table(lines, b"v", 3, 3), number_table(lines, b"vt", 2, 1), number_table(lines, b"vn", 3, 3)]
    corners = face_corners(lines)
    geometry = GeometryFile([], [])
    switches, names = _statements(lines, geometry, folder, path)
    distinct = {name: k for k, name in enumerate(dict.fromkeys(names))}
    number = np.array([distinct[name] for name in names])
    if not len(corners.per_face):
        raise SceneError(f"{file}: holds no faces")
    triangles = fans(corners.per_face)
    resolved = _resolved(lines, corners, [len(table) for table in tables])
    face_line = corners.lines[triangles[:, 0]]
    material = number[np.searchsorted(switches, face_line)]
    complete = np.all(corners.given[triangles], axis=1)  # (m, 3): do all corners of the triangle have it?
    kind = material * 4 + complete[:, 1] * 2 + complete[:, 2]
    order = np.argsort(kind, kind="stable")
    begins = np.flatnonzero(np.diff(kind[order], prepend=-1))
    of_number = list(distinct)
    for chosen in np.split(order, begins[1:]):
        value = int(kind[chosen[0]])
        geometry.parts.append(_part(resolved[triangles[chosen]], tables, bool(value & 2), bool(value & 1), of_number[value // 4]))
        geometry.placed.append(Placed(len(geometry.parts) - 1))
    return geometry


def _statements(lines: Lines, geometry: GeometryFile, folder: Folder, path: str) -> tuple[Integers, list[str | None]]:
    """Follows mtllib and usemtl: the lines where the material changes, the material before the first and after each of them."""
    number_lines = np.concatenate([lines.beginning_with(word.encode()) for word in (*_NUMBERS, "f")])
    other = lines.ends > lines.starts
    other[number_lines] = False
    switches: list[int] = []
    names: list[str | None] = [None]
    libraries: set[str] = set()
    free_form = 0
    for line in np.flatnonzero(other).tolist():
        keyword, _, rest = lines.words(line).partition(b" ")
        word, name = keyword.decode("latin-1"), rest.strip().decode("utf-8", "replace")
        if word == "usemtl":
            switches.append(line)
            names.append(name)
        elif word == "mtllib":
            if name not in libraries:
                libraries.add(name)
                _read_library(lines, line, name, geometry, folder, path)
        elif word in _FREE_FORM:
            free_form += 1
        elif word not in _IGNORED:
            raise lines.error(line, "no statement of an .obj")
    if free_form:
        geometry.warnings.append(f"{lines.file}: {free_form} statements of free-form geometry left out")
    return np.array(switches, np.int64), names


def _read_library(lines: Lines, line: int, name: str, geometry: GeometryFile, folder: Folder, path: str) -> None:
    """The .mtl of that name; else, as a list of names is also allowed, each of its words."""
    where = f"{lines.file}:{line + 1}: mtllib"
    name = name.replace("\\", "/")
    whole = folder.locate(name, where, path)
    names = [name] if whole else name.split()
    for single in names:
        found = folder.locate(single, where, path)
        if found is None:
            geometry.warnings.append(f"{where} {single!r} does not exist")
        else:
            geometry.materials.update(read_mtl(found, folder, geometry.warnings))


def _resolved(lines: Lines, corners: Corners, sizes: list[int]) -> Integers:
    """Indices from 0: those below 0 count back from the lines before theirs; SceneError where one is 0 or beyond its table."""
    result = corners.raw - 1
    for k, keyword in enumerate(_NUMBERS):
        raw, given = corners.raw[:, k], corners.given[:, k]
        negative = raw < 0
        if negative.any():
            before = np.searchsorted(lines.beginning_with(keyword.encode()), corners.lines[negative])
            result[negative, k] = before + raw[negative]
        bad = given & ((raw == 0) | (result[:, k] < 0) | (result[:, k] >= sizes[k]))
        if bad.any():
            corner = int(np.argmax(bad))
            raise lines.error(corners.lines[corner], f"index {raw[corner]} of {keyword} is out of range (1 to {sizes[k]})")
    return result


def _part(chosen: Integers, tables: list[NDArray[np.float64]], texcoords: bool, normals: bool, name: str | None) -> Part:
    """Triangles (m, 3, 3) of indices as one part whose vertices are the distinct corners."""
    columns = [0] + [1] * texcoords + [2] * normals
    key, vertex = _distinct(chosen.reshape(-1, 3), columns, tables)
    data = [tables[k][key[:, i]] for i, k in enumerate(columns)]
    return Part(
        positions=data[0],
        triangles=vertex.reshape(-1, 3).astype(np.uint32),
        texcoords=data[1].astype(np.float32) if texcoords else None,
        normals=data[-1].astype(np.float32) if normals else None,
        material=name,
    )


def _distinct(corners: Integers, columns: list[int], tables: list[NDArray[np.float64]]) -> tuple[Integers, Integers]:
    """Distinct rows of the chosen columns and, for each corner, which one it is."""
    code = corners[:, columns[0]].copy()
    span = len(tables[columns[0]])
    for k in columns[1:]:
        if span * len(tables[k]) >= 2**62:
            distinct, code = np.unique(code, return_inverse=True)
            span = len(distinct)
        code = code * len(tables[k]) + corners[:, k]
        span *= len(tables[k])
    _, first, inverse = np.unique(code, return_index=True, return_inverse=True)
    return corners[first][:, columns], inverse.reshape(-1)
