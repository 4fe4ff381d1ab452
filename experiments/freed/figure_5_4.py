"""Figure 5.4: Cracks where the fragments' resolution is too low for the density of the voxels."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture

NAMES = ("128 pixels along a side", "512 pixels along a side")


def studies() -> Sequence[ir.Study]:
    """A steep warp, up to three times as dense at the camera, makes more voxels than there are fragments."""
    grid = ir.Grid(resolution=128, warp=ir.Logistic(steepness=12.0))
    ways = [ir.Rasterization(samples=1, oversampling=pixels) for pixels in (1, 4)]
    return [drawn("fragments coarser than voxels", [VoxelPicture(grid=grid, voxelize=way) for way in ways])]


def chart(records: ir.Records) -> Figure:
    table = records.table
    cracked = table["stage.compare.cracked"] / table["stage.compare.seen"]
    shown = [(f"{name}\n{cracked[i]:.2%} of the pixels see through", as_colour(picture(records, i))) for i, name in enumerate(NAMES)]
    return panels(shown)
