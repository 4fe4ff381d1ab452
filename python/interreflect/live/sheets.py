"""Square maps of lights beside each other in a picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float32]
MOST = 64  # maps on a sheet


def depth_sheet(depths: Sequence[Floats], size: tuple[int, int]) -> Bytes:
    """The first maps of distances: each map's nearest is white, its farthest dark, black is open."""
    tiles = []
    for depth in depths[:MOST]:
        met = np.isfinite(depth)
        near, far = (float(depth[met].min()), float(depth[met].max())) if met.any() else (0.0, 1.0)
        grey = np.where(met, 1 - 0.9 * (np.where(met, depth, near) - near) / max(far - near, 1e-30), 0)
        tiles.append(np.round(255 * np.repeat(grey[..., None], 3, 2)).astype(np.uint8))
    return _sheet(tiles, size)


def flux_sheet(fluxes: Sequence[Floats], size: tuple[int, int]) -> Bytes:
    """The first maps of flux (size, size, 3), each with a mean of middle grey where it is lit."""
    tiles = []
    for flux in fluxes[:MOST]:
        lit = flux.max(-1) > 0
        mean = float(flux[lit].mean()) if lit.any() else 1.0
        exposed = 0.18 * flux / mean
        tiles.append(np.round(255 * (exposed / (1 + exposed)) ** (1 / 2.2)).astype(np.uint8))
    return _sheet(tiles, size)


def fitted(picture: Bytes, size: tuple[int, int]) -> Bytes:
    """A picture in the middle of one of this size (width, height), as large as fits."""
    return _sheet([picture], size)


def _sheet(tiles: Sequence[Bytes], size: tuple[int, int]) -> Bytes:
    from PIL import Image

    width, height = size
    columns = max(range(1, len(tiles) + 1), key=lambda n: min(width // n, height // -(-len(tiles) // n)))
    rows = -(-len(tiles) // columns)
    side = max(1, min(width // columns, height // rows))
    sheet = np.zeros((height, width, 3), np.uint8)
    left, top = (width - columns * side) // 2, (height - rows * side) // 2
    for number, tile in enumerate(tiles):
        filtered = Image.Resampling.BOX if side < len(tile) else Image.Resampling.NEAREST
        shown = np.asarray(Image.fromarray(tile).resize((side, side), filtered))
        y, x = top + number // columns * side, left + number % columns * side
        part = sheet[max(y, 0) : y + side, max(x, 0) : x + side]
        part[:] = shown[: part.shape[0], : part.shape[1]]
    return sheet
