"""Things that stand on surfaces, drawn where the camera sees them: cache sites, surfels, and clusters of surfels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.clusters import DOT, number_colours
from interreflect.scenes.camera import Camera

Bytes = NDArray[np.uint8]
BEHIND = 1.02  # a point farther than the surface by this factor is hidden by it
DENSE = 100  # pixels that a dot has to itself, from which on it is larger than one
CANDIDATES = 4  # nearest surfels of which a pixel takes the first that faces as it does
CLUSTERS = 256  # that surfels are drawn in, about
GREY = np.array([0.75, 0.75, 0.75], np.float32)


def dots(background: Bytes, position: NDArray[np.float32], depth: NDArray[np.float32], camera: Camera) -> Bytes:
    """A dot over the picture for every point (n, 3) that no surface hides. depth: (height, width), along the pixels' rays."""
    height, width = depth.shape
    picture = background.copy()
    x, y, distance = project(position, camera, (width, height))
    seen = (x >= 0) & (x < width) & (y >= 0) & (y < height) & (distance > 0)
    x, y, distance = x[seen].astype(int), y[seen].astype(int), distance[seen]
    shown = distance <= BEHIND * depth[y, x]
    mark(picture, x[shown], y[shown])
    return picture


def mark(picture: Bytes, x: NDArray[np.int64], y: NDArray[np.int64]) -> None:
    """Squares of about a three-hundredth of the picture's width; single pixels where there are many."""
    height, width = picture.shape[:2]
    reach = max(0, round(width / 600)) if len(x) * DENSE < width * height else 0
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            picture[np.clip(y + down, 0, height - 1), np.clip(x + right, 0, width - 1)] = np.round(255 * np.array(DOT)).astype(np.uint8)


def project(position: NDArray[np.float32], camera: Camera, size: tuple[int, int]) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Pixel coordinates x and y, and the distance from the eye, negative behind it; each (n,)."""
    eye = np.asarray(camera.position, np.float64)
    ahead = np.subtract(camera.target, eye)
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, camera.up)
    right /= np.linalg.norm(right)
    to = np.asarray(position, np.float64) - eye
    along = to @ ahead
    scale = 0.5 * size[0] / np.tan(np.radians(camera.fov_x) / 2) / np.where(along > 0, along, np.inf)
    x, y = 0.5 * size[0] + to @ right * scale, 0.5 * size[1] - to @ np.cross(right, ahead) * scale
    return x, y, np.copysign(np.linalg.norm(to, axis=1), along)


def surfel_disks(surfels: Any, gbuffer: _core.GBuffer) -> Bytes:
    """Every surfel's disk in a colour of its own on grey surfaces; disks that overlap end half-way between each other."""
    flat = getattr(surfels, "surfels", surfels)
    number, distance, hit = _nearest(flat, gbuffer)
    radius = np.sqrt(np.asarray(flat.area) / np.pi)
    return _shaded(np.where((distance <= radius[number])[..., None], number_colours(len(flat))[number], GREY), gbuffer, hit)


def surfel_clusters(tree: _core.ClusteredSurfels, gbuffer: _core.GBuffer) -> Bytes:
    """Where each cluster of surfels is the nearest, of about CLUSTERS as large as one another."""
    cluster = cut(tree, max(1, len(tree.surfels) // CLUSTERS))
    number, _, hit = _nearest(tree.surfels, gbuffer)
    return _shaded(number_colours(int(cluster.max()) + 1)[cluster[number]], gbuffer, hit)


def cut(tree: _core.ClusteredSurfels, most: int) -> NDArray[np.int64]:
    """(n,): the number of every surfel's cluster, where clusters are the largest nodes of at most `most` surfels."""
    leaves, end = np.asarray(tree.leaves, np.int64), np.asarray(tree.leaf_end, np.int64)
    found = np.zeros(len(tree.surfels), np.int64)
    number, open_nodes = 0, [len(leaves) - 1]
    while open_nodes:
        node = open_nodes.pop()
        if leaves[node] <= most:
            found[end[node] - leaves[node] : end[node]] = number
            number += 1
        else:
            open_nodes += [node - 1, int(node - 2 * leaves[node - 1])]
    return found


def _nearest(surfels: _core.Surfels, gbuffer: _core.GBuffer) -> tuple[NDArray[np.int64], NDArray[np.float64], NDArray[np.bool_]]:
    """Of every pixel the nearest surfel that faces as its surface does, how far it is, and whether there is a surface."""
    from scipy.spatial import cKDTree

    hit = np.isfinite(gbuffer.depth)
    number, distance = np.zeros(hit.shape, np.int64), np.full(hit.shape, np.inf)
    count = min(CANDIDATES, len(surfels))
    if hit.any() and count:
        apart, index = cKDTree(surfels.position).query(gbuffer.position[hit], k=range(1, count + 1))
        faces = np.abs(np.einsum("pkc,pc->pk", np.asarray(surfels.normal)[index], gbuffer.normal[hit])) > 0.5
        best = np.argmax(faces, 1)[:, None]
        number[hit] = np.take_along_axis(index, best, 1)[:, 0]
        distance[hit] = np.take_along_axis(apart, best, 1)[:, 0]
    return number, distance, hit


def _shaded(colours: NDArray[np.floating], gbuffer: _core.GBuffer, hit: NDArray[np.bool_]) -> Bytes:
    """Colours with a light of the drawing's own, so that edges can be told; black where there is no surface."""
    bright = 0.6 + 0.4 * np.abs(gbuffer.normal @ np.array([0.36, 0.80, 0.48], np.float32))
    shaded: Bytes = np.round(255 * np.where(hit, bright, 0)[..., None] * colours).astype(np.uint8)
    return shaded
