"""Shapes that the built-in scenes are made of: plain arrays, counter-clockwise seen from outside, lengths in scene units."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.checks import Vector
from interreflect.scenes.values import Material, Mesh

Floats = NDArray[np.float64]


class Shape(NamedTuple):
    """Triangles without a material. Faces are flat: corners that need their own normal are separate vertices."""

    positions: Floats  # (vertices, 3)
    triangles: NDArray[np.uint32]  # (triangles, 3)


def join(shapes: Iterable[Shape]) -> Shape:
    """All shapes as one."""
    parts = list(shapes)
    firsts = np.cumsum([0, *(len(part.positions) for part in parts[:-1])])
    triangles = [part.triangles + np.uint32(first) for part, first in zip(parts, firsts, strict=True)]
    return Shape(np.concatenate([part.positions for part in parts]), np.concatenate(triangles))


def moved(shape: Shape, offset: ArrayLike = (0, 0, 0), *, turn: float = 0, scale: ArrayLike = 1) -> Shape:
    """`shape` scaled, then turned counter-clockwise about +y by `turn` degrees, then moved by `offset`."""
    return Shape((shape.positions * np.asarray(scale)) @ rotation_about_y(turn).T + np.asarray(offset), shape.triangles)


def rotation_about_y(degrees: float) -> Floats:
    """(3, 3) rotation counter-clockwise about +y."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])


def flipped(shape: Shape) -> Shape:
    """`shape` facing the other way."""
    return Shape(shape.positions, np.ascontiguousarray(shape.triangles[:, ::-1]))


def face_areas(shape: Shape) -> Floats:
    """Area of every triangle, (triangles,)."""
    a, b, c = (shape.positions[shape.triangles[:, k]] for k in range(3))
    return np.asarray(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1))


def quad(corner: ArrayLike, u: ArrayLike, v: ArrayLike) -> Shape:
    """Parallelogram `corner + [0, 1] u + [0, 1] v`, facing u x v."""
    p, u, v = np.asarray(corner, float), np.asarray(u, float), np.asarray(v, float)
    return Shape(np.array([p, p + u, p + u + v, p + v]), np.array([[0, 1, 2], [0, 2, 3]], np.uint32))


def box(low: ArrayLike, high: ArrayLike) -> Shape:
    """Axis-aligned box between two corners, facing out."""
    p, d = np.asarray(low, float), np.asarray(high, float) - np.asarray(low, float)
    x, y, z = np.diag(d)
    sides = [(p, y, x), (p, x, z), (p, z, y), (p + d, -x, -y), (p + d, -z, -x), (p + d, -y, -z)]
    return join(quad(*side) for side in sides)


def grid_triangles(rows: int, columns: int, *, wrap: bool = False) -> NDArray[np.uint32]:
    """Triangles of a grid of rows x columns vertices; `wrap` joins the last column to the first."""
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if wrap else columns - 1), indexing="ij")
    k = (j + 1) % columns
    a, b, c, d = i * columns + j, i * columns + k, (i + 1) * columns + k, (i + 1) * columns + j
    pairs = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], 2)
    return pairs.reshape(-1, 3).astype(np.uint32)


def without_slivers(shape: Shape) -> Shape:
    """`shape` without triangles whose area is rounding only, and without vertices that none uses."""
    areas = face_areas(shape)
    kept = shape.triangles[areas > 1e-9 * areas.max()]
    used, triangles = np.unique(kept, return_inverse=True)
    return Shape(shape.positions[used], triangles.reshape(-1, 3).astype(np.uint32))


def revolved(profile: ArrayLike, sides: int) -> Shape:
    """Surface of revolution about +y through a `profile` of (points, 2), radius and height, that rises along its outside."""
    radius, height = np.asarray(profile, float).T
    angle = np.arange(sides) * (2 * np.pi / sides)
    x, z = np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))
    positions = np.stack([x, np.broadcast_to(height[:, None], x.shape), z], -1).reshape(-1, 3)
    return without_slivers(flipped(Shape(positions, grid_triangles(len(radius), sides, wrap=True))))


def sphere(radius: float = 1, *, centre: ArrayLike = (0, 0, 0), segments: int = 96) -> Shape:
    """Sphere of `segments` rings, facing out, scaled so that the area of its mesh is the true one."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, segments + 1)
    profile = np.stack([np.cos(angle), np.sin(angle)], 1)
    profile[[0, -1], 0] = 0
    shape = revolved(profile, 2 * segments)
    return moved(shape, centre, scale=radius * np.sqrt(4 * np.pi / face_areas(shape).sum()))


def disk(radius: float = 1, *, centre: ArrayLike = (0, 0, 0), down: bool = False, segments: int = 256) -> Shape:
    """Horizontal disk that faces up or `down`, scaled so that the area of its mesh is the true one."""
    angle = np.arange(segments) * (2 * np.pi / segments)
    rim = np.stack([np.cos(angle), np.zeros(segments), np.sin(angle)], 1)
    scale = np.sqrt(np.pi / (0.5 * segments * np.sin(2 * np.pi / segments)))
    k = np.arange(segments)
    triangles = np.stack([np.zeros_like(k), 1 + (k + 1) % segments, 1 + k], 1).astype(np.uint32)
    up = Shape(np.concatenate([np.zeros((1, 3)), rim * scale * radius]) + np.asarray(centre, float), triangles)
    return flipped(up) if down else up


def ring(half_x: float, half_z: float, profile: ArrayLike) -> Shape:
    """Closed `profile` swept around a rectangle with mitred corners: floors, walls and mouldings of a court.

    `profile` is (points, 2): distance outward from the rectangle, and height, counter-clockwise with outward to the right.
    """
    outward, height = np.asarray(profile, float).T
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    corners = [np.stack([sx * (half_x + outward), height, sz * (half_z + outward)], 1) for sx, sz in signs]
    positions = np.stack([*corners, corners[0]])
    return without_slivers(_facets(positions))


def _facets(grid: Floats) -> Shape:
    """Closed profiles, (rows, points, 3), joined row to row with the last point joined to the first."""
    rows, points = grid.shape[:2]
    return Shape(grid.reshape(-1, 3), grid_triangles(rows, points, wrap=True))


def arcade(span: float, bays: int, radius: float, height: float, thickness: float, segments: int) -> Shape:
    """Wall of `height` along x that stands on its `bays` round arches: springing line at y = 0, x and z around 0."""
    bay = span / bays
    angle = np.linspace(0, np.pi, segments + 1)
    arch = np.stack([-radius * np.cos(angle), radius * np.sin(angle)], 1)
    arch[[0, -1], 1] = 0
    centres = (np.arange(bays) + 0.5) * bay - span / 2
    points = [(-span / 2, 0.0), *((x + c, y) for c in centres for x, y in arch), (span / 2, 0.0)]
    return ribbon(points, height, thickness)


def ribbon(lower: Sequence[tuple[float, float]], height: float, thickness: float) -> Shape:
    """Solid between a lower line y(x), x rising, and y = `height`; `thickness` along z, around 0."""
    x, y = np.asarray(lower, float).T
    top = np.full_like(y, height)
    near, far = np.full_like(x, thickness / 2), np.full_like(x, -thickness / 2)
    lines = [np.stack(line, 1) for line in ((x, y, near), (x, top, near), (x, top, far), (x, y, far))]
    ends = [np.array([line[k] for line in lines]) for k in (0, -1)]
    caps = [quad(e[0], e[3] - e[0], e[1] - e[0]) for e in ends]
    return without_slivers(flipped(join([_facets(np.stack(lines, 1)), caps[0], flipped(caps[1])])))


def sheet(points: Floats) -> Shape:
    """Open surface through a (rows, columns, 3) grid of points, facing (next column - this) x (next row - this)."""
    rows, columns = points.shape[:2]
    return Shape(points.reshape(-1, 3), grid_triangles(rows, columns))


def tube(start: ArrayLike, end: ArrayLike, radius: float, sides: int = 8) -> Shape:
    """Closed cylinder from `start` to `end`."""
    a, axis = np.asarray(start, float), np.asarray(end, float) - np.asarray(start, float)
    length = float(np.linalg.norm(axis))
    y = axis / length
    x = np.cross(y, np.eye(3)[np.argmin(np.abs(y))])
    x /= np.linalg.norm(x)
    upright = revolved([(0, 0), (radius, 0), (radius, length), (0, length)], sides)
    return Shape(upright.positions @ np.stack([x, y, np.cross(x, y)]) + a, upright.triangles)


def box_mapped(shape: Shape, tile: float) -> tuple[Shape, Floats]:
    """`shape` with its faces apart, and texture coordinates that repeat every `tile` units on the axis plane next to a face."""
    corners = shape.positions[shape.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    axis = np.argmax(np.abs(normal) * (1.0, 0.999, 1.0), axis=1)
    across = np.array([(2, 1), (0, 2), (0, 1)])[axis]
    texcoords = np.take_along_axis(corners, across[:, None, :], axis=2) / tile
    flat = Shape(corners.reshape(-1, 3), np.arange(3 * len(corners), dtype=np.uint32).reshape(-1, 3))
    return flat, texcoords.reshape(-1, 2)


def triple(vector: ArrayLike) -> Vector:
    """Three numbers as a tuple, for cameras, lights and materials."""
    x, y, z = (float(v) for v in np.asarray(vector))
    return x, y, z


def mesh(
    shape: Shape,
    material: Material,
    *,
    tile: float | None = None,
    normals: Floats | None = None,
    texcoords: Floats | None = None,
    body: str = "world",
) -> Mesh:
    """`shape` as a mesh, flat without `normals`; with `tile`, its material's maps repeat every `tile` units (`box_mapped`)."""
    if tile is not None:
        shape, texcoords = box_mapped(shape, tile)
    return Mesh(
        shape.positions.astype(np.float32),
        shape.triangles,
        normals=None if normals is None else normals.astype(np.float32),
        texcoords=None if texcoords is None else texcoords.astype(np.float32),
        material=material,
        body=body,
        name=material.name,
    )
