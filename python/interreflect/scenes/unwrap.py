"""Texture coordinates for a light map: charts of the still surface, packed by xatlas."""

from __future__ import annotations

import io
import subprocess
import sys

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.charts_of import pieces_of
from interreflect.scenes.scene import Scene


def unwrap(scene: Scene, texels: int, area_share: float = 0.95) -> NDArray[np.float32]:
    """(3 triangles, 2): texture coordinates of every corner of every triangle, in texels of one square map; -1 without a chart.

    Charts have the largest connected pieces of the still surface that hold `area_share` of its area, but for charts of less than four
    texels. The same area of surface has the same number of texels everywhere, as many as fit."""
    corners, triangles = _core.still_triangles(scene.core)
    texcoord = np.full((triangles, 3, 2), -1, np.float32)
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = np.flatnonzero((area > 0) & large_pieces(corners, area, area_share)) if area.sum() > 0 else ()
    if len(chosen):
        texcoord[chosen] = pack(corners[chosen], area[chosen], texels)
    return texcoord.reshape(-1, 2)


def large_pieces(corners: NDArray[np.float32], area: NDArray[np.float32], area_share: float) -> NDArray[np.bool_]:
    """(n,): triangles of the largest pieces, connected by corners in the same place, that together hold that share of the area."""
    _, vertex = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    piece = pieces_of(vertex.reshape(-1, 3))
    size = np.bincount(piece, weights=area)
    order = np.argsort(-size, kind="stable")
    before = np.concatenate([[0], np.cumsum(size[order])[:-1]])
    taken = np.zeros(len(size), bool)
    taken[order[before < area_share * size.sum() * (1 - 1e-6)]] = True
    return taken[piece]


def pack(corners: NDArray[np.float32], area: NDArray[np.float32], texels: int) -> NDArray[np.float32]:
    """(n, 3, 2): charts_of.pack in a process of its own: when xatlas 0.0.11 lets go of an atlas it may wait for ever for its threads (a
    wake-up that comes before the sleep is lost). The process ends without letting go."""
    given, made = io.BytesIO(), [sys.executable, "-m", "interreflect.scenes.charts_of"]
    np.savez(given, corners=corners, area=area, texels=np.int64(texels))
    done = subprocess.run(made, input=given.getvalue(), capture_output=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"unwrapping for a light map failed: {done.stderr.decode(errors='replace').strip()}")
    packed: NDArray[np.float32] = np.load(io.BytesIO(done.stdout))
    return packed
