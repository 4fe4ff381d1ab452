"""Figure 4.10: Cracks where a warp's slope exceeds 1, and the holes filled by rasterizing at a higher resolution."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture

NAMES = ("rasterized at the grid's resolution", "viewport grown by the largest slope", "tessellated")


def studies() -> Sequence[ir.Study]:
    """The spline's largest slope is 1.5 - alpha / 2 = 1.375; twice the pixels is the next whole number."""
    grid = ir.Grid(resolution=256, warp=ir.CubicSpline(alpha=0.25))
    ways = [ir.Rasterization(samples=4), ir.Rasterization(samples=4, oversampling=2), ir.Tessellation()]
    return [drawn("cracks under a warp", [VoxelPicture(grid=grid, voxelize=way) for way in ways])]


def chart(records: ir.Records) -> Figure:
    table = records.table
    cracked = table["stage.compare.cracked"] / table["stage.compare.seen"]
    shown = [(f"{name}\n{cracked[i]:.2%} of the pixels see through", as_colour(picture(records, i))) for i, name in enumerate(NAMES)]
    return panels(shown, columns=3)
