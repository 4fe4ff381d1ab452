"""Voxels drawn as cubes, flat shaded, as papers show them: only faces between a voxel and air, seen by a camera."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.camera import Camera, checked_size
from interreflect.scenes.mesh import Mesh
from interreflect.scenes.scene import Scene
from interreflect.stages import trace_gbuffer

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]

# Where the drawing's own light comes from: it tells the three axes apart. Faces that look at it are shown as bright as they are.
TOWARDS_LIGHT = np.array([0.36, 0.80, 0.48], np.float32)
# The corners of a cell's face across axis 0, 1, 2, in order around it, less the step along the axis itself.
AROUND = np.array(
    [
        [[0, 0, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]],
        [[0, 0, 0], [0, 0, 1], [1, 0, 1], [1, 0, 0]],
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]],
    ],
    np.int16,
)


@dataclass(frozen=True, eq=False)
class VoxelView:
    """image: (height, width, 3) float32. depth: (height, width), along the ray to the first voxel, scene units, infinite where none is.

    cell: (height, width, 3) int32, x y z of that voxel, -1 where none is. faces: how many lie between a voxel and air, in all.
    """

    image: Floats
    depth: Floats
    cell: Ints
    faces: int


def voxel_view(
    voxels: Any, camera: Camera, size: tuple[int, int] | None = None, *, level: int = 0, colours: NDArray[np.floating] | None = None
) -> VoxelView:
    """Draws voxels as cubes, as the camera sees them.

    voxels: a VoxelGrid (its albedo is shown), LitVoxels (radiance of the side that faces the camera) or a Pyramid (radiance of `level`
    as it is stored, premultiplied by opacity: what lies dark is thin). colours: (n, 3), shown instead, a row per voxel of the grid.
    size: (width, height), None: the camera's. Cells of a warped grid are drawn with straight edges between their corners.

    TypeError for other values, IndexError for a level that a pyramid lacks, ValueError for colours of another number.
    """
    domain, cells, shown, width = _cubes(voxels, camera, level)
    if colours is not None:
        shown = np.asarray(colours, np.float32)
        if shown.shape != (len(cells), 3):
            raise ValueError(f"colours must have the shape ({len(cells)}, 3), got {shown.shape}")
    owner, axis, side = exposed_faces(cells)
    view = camera.size if size is None else checked_size(size)
    corners = _corners(domain, cells, owner, axis, side, width)
    normals = _outward(domain, cells, owner, corners, width)
    seen = _may_be_seen(corners, normals, camera, view)
    return _draw(corners[seen], normals[seen], cells[owner[seen]], shown[owner[seen]], camera, view, len(owner))


def exposed_faces(cells: NDArray[np.integer]) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Faces between cells, (n, 3) integers, and empty ones: number of the cell, axis 0 to 2, and side 0 (lower) or 1 (upper)."""
    if len(cells) == 0:
        none = np.zeros(0, np.intp)
        return none, none, none
    lowest = cells.min(0)
    place = cells - lowest + 1  # an empty cell on all sides
    filled = np.zeros(cells.max(0) - lowest + 3, bool)
    filled[tuple(place.T)] = True
    found = []
    for axis in range(3):
        for side in (0, 1):
            beside = place.copy()
            beside[:, axis] += 2 * side - 1
            owner = np.flatnonzero(~filled[tuple(beside.T)])
            found.append((owner, np.full(len(owner), axis), np.full(len(owner), side)))
    owners, axes, sides = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return owners, axes, sides


def cell_diagonals(domain: _core.Domain, cells: NDArray[np.integer]) -> Floats:
    """(n,): distance between opposite corners of cells (n, 3), scene units."""
    lower, upper = _to_world(domain, cells, 1), _to_world(domain, cells + 1, 1)
    length: Floats = np.linalg.norm(upper - lower, axis=1)
    return length


def _cubes(voxels: Any, camera: Camera, level: int) -> tuple[_core.Domain, Ints, Floats, int]:
    """The domain, cells (n, 3), colours (n, 3), and the width of a cell in voxels of the domain."""
    if isinstance(voxels, _core.VoxelGrid):
        return voxels.domain, voxels.coordinates, voxels.albedo, 1
    if isinstance(voxels, _core.LitVoxels):
        return voxels.voxels.domain, voxels.voxels.coordinates, _facing_radiance(voxels, camera), 1
    if isinstance(voxels, _core.Pyramid):
        texels = voxels.level(level)
        z, y, x = np.nonzero(texels[..., 3] > 0)
        return voxels.domain, np.stack([x, y, z], 1).astype(np.int32), texels[z, y, x, :3], 1 << level
    raise TypeError(f"voxel_view draws a VoxelGrid, LitVoxels or a Pyramid, got {type(voxels).__name__}")


def _facing_radiance(lit: _core.LitVoxels, camera: Camera) -> Floats:
    """Of the side that looks at the camera; of the front where the back was not lit apart."""
    if len(lit.back) == 0:
        return np.asarray(lit.radiance)
    towards = np.asarray(camera.position, np.float32) - lit.voxels.position
    is_back = np.einsum("ij,ij->i", towards, lit.voxels.normal) < 0
    facing: Floats = np.where(is_back[:, None], lit.back, lit.radiance)
    return facing


def _corners(
    domain: _core.Domain, cells: Ints, owner: NDArray[np.intp], axis: NDArray[np.intp], side: NDArray[np.intp], width: int
) -> Floats:
    """(faces, 4, 3): world space, in order around each face."""
    steps: NDArray[np.int16] = AROUND[axis]
    steps[np.arange(len(axis)), :, axis] += side[:, None].astype(np.int16)
    return _to_world(domain, cells[owner][:, None] + steps, width)


def _to_world(domain: _core.Domain, corner: NDArray[Any], width: int) -> Floats:
    """World space of points in cells that are so many voxels wide; what reaches beyond the domain ends with it."""
    voxels = np.minimum(corner * np.float32(width), np.asarray(domain.cells, np.float32)).astype(np.float32)
    world: Floats = np.asarray(domain.lower, np.float32) + voxels * np.float32(domain.voxel_size)
    return world


def _outward(domain: _core.Domain, cells: Ints, owner: NDArray[np.intp], corners: Floats, width: int) -> Floats:
    """(faces, 3): unit normals that point out of the cells."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-30))
    out = corners.mean(1) - _to_world(domain, cells[owner] + 0.5, width)
    flip = np.einsum("ij,ij->i", normals, out) < 0
    outward: Floats = np.where(flip[:, None], -normals, normals)
    return outward


def _may_be_seen(corners: Floats, normals: Floats, camera: Camera, size: tuple[int, int]) -> NDArray[np.bool_]:
    """Faces that look at the camera and are not wholly outside one side of what it sees."""
    eye = np.asarray(camera.position, np.float32)
    towards = corners - eye
    facing = np.einsum("ij,ij->i", normals, towards[:, 0]) < 0
    view = np.subtract(camera.target, camera.position)
    ahead = view / np.linalg.norm(view)
    right = np.cross(ahead, camera.up)
    right /= np.linalg.norm(right)
    tangent = np.tan(np.radians(camera.fov_x) / 2)
    seen: NDArray[np.bool_] = facing
    for axis, slope in ((right, tangent), (np.cross(right, ahead), tangent * size[1] / size[0])):
        for sign in (-1, 1):
            plane = (ahead * slope + sign * axis).astype(np.float32)
            seen &= (towards @ plane > 0).any(1)
    return seen


def _draw(corners: Floats, normals: Floats, cells: Ints, colours: Floats, camera: Camera, size: tuple[int, int], faces: int) -> VoxelView:
    count = len(corners)
    first = 4 * np.arange(count, dtype=np.uint32)[:, None]
    triangles = (first + np.array([0, 1, 2, 0, 2, 3], np.uint32)).reshape(-1, 3)
    meshes = [Mesh(corners.reshape(-1, 3), triangles)] if count else []
    seen = trace_gbuffer(Scene(meshes=meshes), camera, size)
    hit = np.isfinite(seen.depth)
    face = seen.triangle[hit] // 2
    image = np.zeros((*hit.shape, 3), np.float32)
    image[hit] = (colours * (0.7 + 0.3 * (normals @ TOWARDS_LIGHT))[:, None])[face]
    cell = np.full((*hit.shape, 3), -1, np.int32)
    cell[hit] = cells[face]
    return VoxelView(image, np.array(seen.depth), cell, faces)
