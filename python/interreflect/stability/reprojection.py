"""Where was a surface point in the frame before? Reprojection through G-buffers, with the motion of bodies."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stages import trace_gbuffer

Floats = NDArray[np.float64]
SAME_PLANE = 2.0  # pixel footprints that a neighbour's point may lie off the surface point's plane
ALL = 0.999  # of the weight must lie on the same surface; rounding alone may miss the rest
SAME_NORMAL = 0.9  # least cosine between their normals


@dataclasses.dataclass(frozen=True, eq=False)
class Surfaces:
    """What a frame shows: position and normal (height, width, 3) in the world, body (height, width) with -1 for nothing."""

    position: Floats
    normal: Floats
    body: NDArray[np.int64]
    depth: Floats
    camera: Camera
    poses: tuple[Floats, ...]  # of the bodies, by number

    @property
    def size(self) -> tuple[int, int]:
        return self.body.shape[1], self.body.shape[0]


@dataclasses.dataclass(frozen=True, eq=False)
class Origin:
    """For every pixel, four pixels of the frame before and their bilinear weights; `found`: whether all four show the same surface."""

    pixels: NDArray[np.int64]  # (4, height, width), indices into the raveled picture
    weights: Floats  # (4, height, width)
    found: NDArray[np.bool_]

    def fetch(self, image: NDArray[np.floating]) -> Floats:
        """The picture of the frame before at this frame's surface points, (height, width, 3); meaningless where not found."""
        flat = np.asarray(image, np.float64).reshape(-1, image.shape[2])
        return np.asarray(np.einsum("khw,khwc->hwc", self.weights, flat[self.pixels]))


def surfaces(scene: Scene, camera: Camera, size: tuple[int, int]) -> Surfaces:
    """The surfaces behind pixel centres."""
    gbuffer = trace_gbuffer(scene, camera, size)
    seen = np.isfinite(gbuffer.depth)
    return Surfaces(
        position=np.asarray(gbuffer.position, np.float64),
        normal=np.asarray(gbuffer.geometric_normal, np.float64),
        body=np.where(seen, gbuffer.body.astype(np.int64), -1),
        depth=np.where(seen, gbuffer.depth, 0.0).astype(np.float64),
        camera=camera,
        poses=tuple(np.asarray(pose) for pose in scene.bodies.values()),
    )


def origin(now: Surfaces, before: Surfaces) -> Origin:
    """Where the surface points of `now` were in the frame `before`, whose scene had the same bodies."""
    position, normal = _carried_back(now, before)
    x, y, in_front = project(before.camera, position, before.size)
    width, height = before.size
    left, top = np.clip(np.floor(x), -1, width), np.clip(np.floor(y), -1, height)
    footprint = pixel_angle(before.camera, before.size) * np.linalg.norm(position - before.camera.position, axis=-1)
    pixels, weights = [], []
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        column, row = (left + dx).astype(np.int64), (top + dy).astype(np.int64)
        weight = np.maximum(0, 1 - np.abs(x - column)) * np.maximum(0, 1 - np.abs(y - row))
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        index = np.where(inside, row * width + column, 0)
        same = _same_surface(before, index, position, normal, now.body, footprint)
        pixels.append(index)
        weights.append(np.where(inside & same, weight, 0.0))
    total = np.sum(weights, axis=0)
    found = (now.body >= 0) & in_front & (total > ALL)
    return Origin(np.stack(pixels), np.stack(weights) / np.where(found, total, 1.0), found)


def project(camera: Camera, points: Floats, size: tuple[int, int]) -> tuple[Floats, Floats, NDArray[np.bool_]]:
    """Column and row at which a camera sees points (..., 3), 0 at the first pixel's centre; and whether they lie in front of it."""
    forward, right, down = _axes(camera)
    away = points - np.asarray(camera.position)
    depth = away @ forward
    in_front = depth > 0
    scale = 1 / (np.where(in_front, depth, 1.0) * pixel_angle(camera, size))
    return (away @ right) * scale + size[0] / 2 - 0.5, (away @ down) * scale + size[1] / 2 - 0.5, in_front


def pixel_angle(camera: Camera, size: tuple[int, int]) -> float:
    """Width of a pixel at distance 1 along the view."""
    return float(2 * np.tan(np.radians(camera.fov_x / 2)) / size[0])


def _axes(camera: Camera) -> tuple[Floats, Floats, Floats]:
    forward = np.subtract(camera.target, camera.position)
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    return forward, right, np.cross(forward, right)


def _carried_back(now: Surfaces, before: Surfaces) -> tuple[Floats, Floats]:
    """Positions and normals of `now` where their bodies were before."""
    position, normal = now.position.copy(), now.normal.copy()
    for number, (pose, earlier) in enumerate(zip(now.poses, before.poses, strict=True)):
        if np.array_equal(pose, earlier):
            continue
        back, own = earlier @ np.linalg.inv(pose), now.body == number
        position[own] = position[own] @ back[:3, :3].T + back[:3, 3]
        normal[own] = normal[own] @ back[:3, :3].T
    return position, normal


def _same_surface(
    before: Surfaces, index: NDArray[np.int64], position: Floats, normal: Floats, body: NDArray[np.int64], footprint: Floats
) -> NDArray[np.bool_]:
    """Do the pixels `index` of `before` show the surface on which these points lie?"""
    there, facing = before.position.reshape(-1, 3)[index], before.normal.reshape(-1, 3)[index]
    off_plane = np.abs(np.einsum("hwc,hwc->hw", there - position, normal))
    aligned = np.einsum("hwc,hwc->hw", facing, normal) > SAME_NORMAL
    return np.asarray((before.body.ravel()[index] == body) & aligned & (off_plane < SAME_PLANE * footprint))
