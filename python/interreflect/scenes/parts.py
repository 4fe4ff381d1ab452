"""What geometry files hold, before materials are known: parts, cleaned of what SCENE_FORMAT.md drops or recomputes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.camera import Camera
from interreflect.scenes.lights import Light
from interreflect.scenes.mesh import IDENTITY

Floats = NDArray[np.float32]
NORMALS = ("file", "flat", "smooth")


@dataclass
class Part:
    """Triangles of one material: positions (n, 3) as precise as the file has them, triangles (m, 3), normals (n, 3), texcoords (n, 2).

    group: parts of one group touch each other, so that smooth normals are shared between them.
    """

    positions: NDArray[np.floating[Any]]
    triangles: NDArray[np.uint32]
    normals: Floats | None = None
    texcoords: Floats | None = None
    material: str | None = None
    group: int = 0


@dataclass
class Placed:
    """A part of a file where the file puts it: (4, 4) float64."""

    part: int
    transform: NDArray[np.float64] = field(default_factory=lambda: IDENTITY)


@dataclass
class GeometryFile:
    """Everything a geometry file defines. materials: name -> keys of SCENE_FORMAT.md with files located."""

    parts: list[Part]
    placed: list[Placed]
    materials: dict[str, dict[str, Any]] = field(default_factory=dict)
    lights: list[Light] = field(default_factory=list)
    cameras: dict[str, Camera] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)


def fans(per_face: NDArray[np.int64]) -> NDArray[np.int64]:
    """(m, 3) numbers of corners, for polygons of that many corners one after the other: each a fan around its first corner."""
    first = np.cumsum(per_face) - per_face
    if (per_face == 3).all():
        return first[:, None] + np.arange(3)
    count = per_face - 2
    face = np.repeat(np.arange(len(per_face)), count)
    step = np.arange(len(face)) - np.repeat(np.cumsum(count) - count, count)
    return np.stack([first[face], first[face] + step + 1, first[face] + step + 2], 1)


def checked_part(
    where: str,
    positions: NDArray[Any],
    triangles: NDArray[Any],
    normals: NDArray[Any] | None = None,
    texcoords: NDArray[Any] | None = None,
    material: str | None = None,
    group: int = 0,
) -> Part:
    """A part of finite numbers in float32 and indices in range; SceneError opens with `where`."""
    if triangles.size and (triangles.min() < 0 or triangles.max() >= len(positions)):
        bad = triangles[(triangles < 0) | (triangles >= len(positions))][0]
        raise SceneError(f"{where}: vertex index must lie in [0, {len(positions)}), got {bad}")
    _finite(where, "position", positions)
    return Part(
        positions if positions.dtype.kind == "f" else positions.astype(np.float32),
        triangles.astype(np.uint32),
        None if normals is None else _finite(where, "normal", normals),
        None if texcoords is None else _finite(where, "texcoord", texcoords),
        material,
        group,
    )


def _finite(where: str, name: str, array: NDArray[Any]) -> Floats:
    with np.errstate(over="ignore"):  # what does not fit becomes infinite, and infinite is refused
        numbers = array.astype(np.float32)
    finite = np.isfinite(numbers)
    if not finite.all():
        row = int(np.argwhere(~finite)[0][0])
        raise SceneError(f"{where}: {name} {row} must be finite in 32 bits, got {array[row].tolist()}")
    return numbers


def cleaned(file: str, parts: Sequence[Part], mode: str, warnings: list[str]) -> list[Part]:
    """Parts without zero-area triangles and unused vertices, with normals of `mode`; warns of what was dropped or recomputed."""
    areas = [_has_area(part) for part in parts]
    dropped = sum(int((~has_area).sum()) for has_area in areas)
    if dropped:
        warnings.append(f"{file}: {dropped} triangles without area dropped")
    parts = [_compact(part, has_area) for part, has_area in zip(parts, areas, strict=True)]
    if mode == "flat":
        return [replace(part, normals=None) for part in parts]
    if mode == "smooth":
        return _smoothed(parts)
    recomputed = 0
    result = []
    for part in parts:
        part, count = _with_unit_normals(part)
        recomputed += count
        result.append(part)
    if recomputed:
        warnings.append(f"{file}: {recomputed} normals without length recomputed")
    return result


def _has_area(part: Part) -> NDArray[np.bool_]:
    """Whether each triangle has an area, both in the numbers of the file and in the 32 bits that are kept of them."""
    has_area = np.ones(len(part.triangles), bool)
    for positions in (part.positions, part.positions.astype(np.float32)):
        corners = positions.astype(np.float64)[part.triangles]
        has_area &= np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]).any(1)
    return has_area


def _compact(part: Part, keep: NDArray[np.bool_]) -> Part:
    """Only the kept triangles and the vertices they use."""
    triangles = part.triangles if keep.all() else part.triangles[keep]
    used = np.zeros(len(part.positions), bool)
    used[triangles.ravel()] = True
    if used.all():
        return replace(part, triangles=triangles)
    renumbered = (np.cumsum(used) - 1).astype(np.uint32)[triangles]
    normals, texcoords = (None if array is None else array[used] for array in (part.normals, part.texcoords))
    return replace(part, positions=part.positions[used], triangles=renumbered, normals=normals, texcoords=texcoords)


def _with_unit_normals(part: Part) -> tuple[Part, int]:
    """Normals made unit length, those without length recomputed, and how many those were."""
    if part.normals is None:
        return part, 0
    normals = part.normals.astype(np.float64)
    largest = np.abs(normals).max(1, initial=0, keepdims=True)
    without = largest[:, 0] == 0
    normals /= np.where(largest > 0, largest, 1)  # first by the largest component: squares of tiny numbers vanish
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 0.5)
    if without.any():
        normals[without] = smooth_normals(part.positions, part.triangles)[without]
    return replace(part, normals=normals.astype(np.float32)), int(without.sum())


def _smoothed(parts: Sequence[Part]) -> list[Part]:
    result = list(parts)
    for group in dict.fromkeys(part.group for part in parts):
        members = [k for k, part in enumerate(parts) if part.group == group]
        starts = np.cumsum([0] + [len(parts[k].positions) for k in members])
        positions = np.concatenate([parts[k].positions for k in members])
        shifted = [parts[k].triangles.astype(np.int64) + start for k, start in zip(members, starts[:-1], strict=True)]
        triangles = np.concatenate(shifted)
        normals = smooth_normals(positions, triangles)
        for k, start, end in zip(members, starts[:-1], starts[1:], strict=True):
            result[k] = replace(parts[k], normals=normals[start:end].astype(np.float32))
    return result


def smooth_normals(positions: NDArray[Any], triangles: NDArray[Any]) -> NDArray[np.float64]:
    """(n, 3) unit normals, each the angle-weighted mean over the triangles that meet at an equal position.

    Where they cancel, the normal of one of those triangles; where there is none, (0, 0, 1).
    """
    if not len(positions):
        return np.zeros((0, 3))
    rows = np.ascontiguousarray(positions.astype(np.float32) + np.float32(0))  # -0 equals 0
    _, first, merged = np.unique(rows.view(np.dtype((np.void, 12))).ravel(), return_index=True, return_inverse=True)
    points = rows[first].astype(np.float64)
    points -= points.mean(0)
    indices = merged.reshape(-1)[triangles.astype(np.int64)]
    corners = points[indices]
    scale = np.abs(corners - corners[:, :1]).max((1, 2), initial=0, keepdims=True)
    corners = (corners - corners[:, :1]) / np.where(scale > 0, scale, 1)
    faces = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    total = np.zeros_like(points)
    last = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    for k in range(3):
        ahead, back = _unit(corners[:, (k + 1) % 3] - corners[:, k]), _unit(corners[:, (k + 2) % 3] - corners[:, k])
        weighted = faces * np.arccos(np.clip((ahead * back).sum(1), -1, 1))[:, None]
        for axis in range(3):
            total[:, axis] += np.bincount(indices[:, k], weighted[:, axis], len(points))
        last[indices[:, k]] = faces
    length = np.linalg.norm(total, axis=1, keepdims=True)
    cancelled = length[:, 0] < 1e-9  # sums of angles times unit vectors are of the order of 1
    normals = np.where(cancelled[:, None], last, total / np.where(length > 0, length, 1))
    return normals[merged.reshape(-1)]


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    length: NDArray[np.float64] = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)
