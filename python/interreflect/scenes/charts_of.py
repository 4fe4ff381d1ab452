"""Charts of triangles, packed by xatlas: `python -m interreflect.scenes.charts_of` reads corners, area and texels from its input (npz) and
writes texture coordinates (npy)."""

from __future__ import annotations

import io
import os
import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

# Texels between those that look-ups in charts read, which xatlas keeps apart by itself, but for ends of charts thinner than a texel.
PADDING = 1
LEAST_TEXELS = 4.0  # of a chart
TRIES = 9  # of scales, by bisection
# Along the scene's longest side, while charts are cut: xatlas stretches each to whole texels (1 % on Sponza), and packs them in vain.
CHART_TEXELS = 1024.0
# xatlas takes as long for a chart as the square of its triangles: pieces of more than so many get charts of about so few, where not even
# so many texels would be theirs were no texel lost.
DENSE_TRIANGLES, CHART_TRIANGLES, PIECE_TEXELS = 2048, 512, 256.0
MOST_SEARCHED = 512  # texels on a side up to which charts are tried in every place, which fills a map by a tenth more
_atlases: list[Any] = []


def held(atlas: Any) -> Any:
    """Kept to the end of the process: see unwrap.pack."""
    _atlases.append(atlas)
    return atlas


def pieces_of(triangles: NDArray[Any]) -> NDArray[np.int32]:
    """(n,): number of the connected piece of each triangle (n, 3)."""
    if not len(triangles):
        return np.zeros(0, np.int32)
    n = int(triangles.max()) + 1
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]]])
    _, label = connected_components(coo_array((np.ones(len(ends), bool), (ends[:, 0], ends[:, 1])), shape=(n, n)), directed=False)
    piece: NDArray[np.int32] = label[triangles[:, 0]]
    return piece


def pack(corners: NDArray[np.float32], area: NDArray[np.float32], texels: int) -> NDArray[np.float32]:
    """(n, 3, 2): texture coordinates of triangles (n, 3, 3) in texels, at the finest scale found at which all charts that are large
    enough there fit into one map; -1 for the others."""
    finest = texels / float(np.sqrt(area.sum()))  # texels a unit of length, were nothing lost between charts
    charts, faces = cut(corners, finest)
    chart = pieces_of(faces)
    size = np.bincount(chart, weights=area)[chart]  # of each triangle's chart, scene units squared
    low, high, scale = 0.0, finest, 0.8 * finest
    best = np.full((*corners.shape[:2], 2), -1, np.float32)
    for _ in range(TRIES):
        large = size * scale**2 >= LEAST_TEXELS
        packed = place(charts, faces[large], scale, texels)
        if packed is None:
            high = scale
        else:
            low, best = scale, np.full_like(best, -1)
            best[large] = packed
        scale = 0.5 * (low + high)
    return best


def cut(corners: NDArray[np.float32], finest: float) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Charts of triangles (n, 3, 3): texture coordinates (m, 2) in units of the surface's length, and the triangles' corners (n, 3).
    finest: texels a unit of length that no map will exceed."""
    # The same charts whatever the scene's place and unit: xatlas knows lengths below which it welds.
    low, extent = corners.reshape(-1, 3).min(0), float(np.ptp(corners.reshape(-1, 3), axis=0).max())
    positions, vertex = np.unique((corners.reshape(-1, 3) - low) / np.float32(extent), axis=0, return_inverse=True)
    triangles = vertex.reshape(-1, 3).astype(np.uint32)
    piece = pieces_of(triangles)
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    hardly_shown = np.bincount(piece, weights=area) * (finest * extent) ** 2 < PIECE_TEXELS
    dense = np.flatnonzero(hardly_shown & (np.bincount(piece) > DENSE_TRIANGLES))
    groups = [np.flatnonzero(piece == one) for one in dense]
    rest = np.flatnonzero(~np.isin(piece, dense))
    faces, charts, count = np.empty_like(triangles), [], 0
    for group in groups + [rest] * bool(len(rest)):
        # By the mean triangle of a place on the surface.
        largest = 0.0 if group is rest else CHART_TRIANGLES * float((area[group] ** 2).sum() / area[group].sum())
        made, faces[group] = cut_piece(positions, triangles[group], largest)
        faces[group] += np.uint32(count)
        charts.append(made * np.float32(extent))
        count += len(made)
    return np.concatenate(charts), faces


def cut_piece(
    positions: NDArray[np.float32], triangles: NDArray[np.uint32], largest: float
) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """`cut` of triangles (n, 3) into charts of at most the area `largest` (0: any)."""
    import xatlas

    used, corner = np.unique(triangles, return_inverse=True)
    atlas = held(xatlas.Atlas())
    atlas.add_mesh(positions[used], corner.reshape(-1, 3).astype(np.uint32))
    cutting, packing = xatlas.ChartOptions(), xatlas.PackOptions()
    cutting.max_chart_area, packing.texels_per_unit = largest, CHART_TEXELS
    atlas.generate(cutting, packing)
    _, faces, texcoord = atlas.get_mesh(0)
    return (texcoord * (atlas.width, atlas.height) / CHART_TEXELS).astype(np.float32), faces


def place(charts: NDArray[np.float32], faces: NDArray[np.uint32], scale: float, texels: int) -> NDArray[np.float32] | None:
    """(n, 3, 2): the charts of these triangles at that scale, in texels; None where they do not fit."""
    import xatlas

    if not len(faces):
        return np.empty((0, 3, 2), np.float32)

    used, corner = np.unique(faces, return_inverse=True)
    atlas = held(xatlas.Atlas())
    atlas.add_uv_mesh(charts[used] * np.float32(scale), corner.reshape(-1, 3).astype(np.uint32))
    options = xatlas.PackOptions()
    options.padding, options.texels_per_unit, options.bilinear = PADDING, 1.0, True
    options.resolution, options.bruteForce = texels, texels <= MOST_SEARCHED
    atlas.generate(xatlas.ChartOptions(), options)
    if max(atlas.width, atlas.height) > texels or atlas.atlas_count != 1:
        return None
    _, indices, texcoord = atlas.get_mesh(0)
    packed: NDArray[np.float32] = (texcoord * (atlas.width, atlas.height))[indices].astype(np.float32)
    return packed


def main() -> None:
    given = np.load(io.BytesIO(sys.stdin.buffer.read()))
    np.save(sys.stdout.buffer, pack(given["corners"], given["area"], int(given["texels"])))
    sys.stdout.buffer.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
