"""Illuminance composition, whose precomputation frames must repay, beside rivals that have none."""

from __future__ import annotations

from typing import Any

import interreflect as ir
from experiments.shared.rivals import rivals

SURFELS = {1024: (16, 4), 4096: (64, 6), 16384: (128, 8), 32768: (254, 12)}  # links, and cells of the grid along a side
COMPOSITION = "illuminance-composition"


def methods() -> list[Any]:
    """From rough to fine, surfels, links and caches together; then cones, clustered caches and virtual area lights."""
    ours = [
        ir.methods.IlluminanceComposition(
            place_surfels=ir.HaltonSurfels(surfels=surfels), link=ir.ShLinks(links=links, bands=bands),
            place_caches=ir.LightMap(texels=8 * cells, grid=ir.CacheGrid(nx=cells, ny=cells, nz=cells)),
        )
        for surfels, (links, cells) in SURFELS.items() for bands in (2, 3, 4)
    ]  # fmt: skip
    return [*ours, *rivals()]


def scenes() -> list[ir.Scene]:
    return [ir.scenes.cornell_box(light="spot"), ir.scenes.atrium()]
