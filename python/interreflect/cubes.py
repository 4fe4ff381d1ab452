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
# Faces reach beyond their edges by this share, so that no ray slips between two of them.
OVERLAP = np.float32(2e-4)
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

    TypeError for other values, IndexError for a level that a pyramid lacks, ValueError for colours of another number and for the
    pyramid of nested grids.
    """
    cubes, shown = _cubes(voxels, camera, level)
    if colours is not None:
        shown = np.asarray(colours, np.float32)
        if shown.shape != (len(cubes.cells), 3):
            raise ValueError(f"colours must have the shape ({len(cubes.cells)}, 3), got {shown.shape}")
    # Nested grids stand beside each other here, so that none is beside another's voxels.
    apart = cubes.cells + (cubes.cascade * (max(cubes.domain.cells) + 2))[:, None]
    owner, axis, side = exposed_faces(apart)
    view = camera.size if size is None else checked_size(size)
    corners = _corners(cubes, owner, axis, side)
    normals = _outward(cubes, owner, corners)
    seen = _may_be_seen(corners, normals, camera, view)
    return _draw(corners[seen], normals[seen], cubes.cells[owner[seen]], shown[owner[seen]], camera, view, len(owner))


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


@dataclass(frozen=True, eq=False)
class _Cubes:
    """Cells (n, 3) of one of a domain's nested grids (n,), each `width` voxels wide."""

    domain: _core.Domain
    cells: Ints
    cascade: NDArray[np.integer]
    width: int = 1

    def to_world(self, owner: NDArray[np.intp], corner: NDArray[Any]) -> Floats:
        """World space of points (n, ..., 3) in the grids of the cells `owner`; what reaches beyond a grid ends with it."""
        voxels = np.minimum(corner * np.float32(self.width), np.asarray(self.domain.cells, np.float32)).astype(np.float32)
        world: Floats = np.empty_like(voxels)
        grid = self.cascade[owner]
        for number in range(self.domain.cascades):
            own = grid == number
            world[own] = self.domain.to_world(voxels[own].reshape(-1, 3), number).reshape(voxels[own].shape)
        return world


def _cubes(voxels: Any, camera: Camera, level: int) -> tuple[_Cubes, Floats]:
    """Where cubes stand, and their colours (n, 3)."""
    if isinstance(voxels, _core.VoxelGrid):
        return _of_grid(voxels), voxels.albedo
    if isinstance(voxels, _core.LitVoxels):
        return _of_grid(voxels.voxels), _facing_radiance(voxels, camera)
    if isinstance(voxels, _core.Pyramid):
        if voxels.domain.cascades > 1:
            raise ValueError("voxel_view draws the pyramid of one grid, not of nested ones")
        texels = voxels.level(level)
        z, y, x = np.nonzero(texels[..., 3] > 0)
        return _Cubes(voxels.domain, np.stack([x, y, z], 1).astype(np.int32), np.zeros(len(x), np.int64), 1 << level), texels[z, y, x, :3]
    raise TypeError(f"voxel_view draws a VoxelGrid, LitVoxels or a Pyramid, got {type(voxels).__name__}")


def _of_grid(voxels: _core.VoxelGrid) -> _Cubes:
    cells_of_grid = int(np.prod(voxels.domain.cells))
    return _Cubes(voxels.domain, voxels.coordinates, voxels.cell // np.uint32(cells_of_grid))


def _facing_radiance(lit: _core.LitVoxels, camera: Camera) -> Floats:
    """Of the side that looks at the camera; of the front where the back was not lit apart."""
    if len(lit.back) == 0:
        return np.asarray(lit.radiance)
    towards = np.asarray(camera.position, np.float32) - lit.voxels.position
    is_back = np.einsum("ij,ij->i", towards, lit.voxels.normal) < 0
    facing: Floats = np.where(is_back[:, None], lit.back, lit.radiance)
    return facing


def _corners(cubes: _Cubes, owner: NDArray[np.intp], axis: NDArray[np.intp], side: NDArray[np.intp]) -> Floats:
    """(faces, 4, 3): world space, in order around each face."""
    steps: NDArray[np.int16] = AROUND[axis]
    steps[np.arange(len(axis)), :, axis] += side[:, None].astype(np.int16)
    return cubes.to_world(owner, cubes.cells[owner][:, None] + steps)


def _outward(cubes: _Cubes, owner: NDArray[np.intp], corners: Floats) -> Floats:
    """(faces, 3): unit normals that point out of the cells."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-30))
    out = corners.mean(1) - cubes.to_world(owner, cubes.cells[owner] + 0.5)
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
    middle = corners.mean(1, keepdims=True)
    meshes = [Mesh((corners + OVERLAP * (corners - middle)).reshape(-1, 3), triangles)] if count else []
    seen = trace_gbuffer(Scene(meshes=meshes), camera, size)
    hit = np.isfinite(seen.depth)
    face = seen.triangle[hit] // 2
    image = np.zeros((*hit.shape, 3), np.float32)
    image[hit] = (colours * (0.7 + 0.3 * (normals @ TOWARDS_LIGHT))[:, None])[face]
    cell = np.full((*hit.shape, 3), -1, np.int32)
    cell[hit] = cells[face]
    return VoxelView(image, np.array(seen.depth), cell, faces)
