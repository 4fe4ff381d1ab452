"""Figure 5.3: Rasterized and tessellated voxels."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture

NAMES = ("rasterized, 4 samples", "tessellated", "tessellated as printed: a vertex a voxel, levels of at most 64")


def studies() -> Sequence[ir.Study]:
    ways = [ir.Rasterization(samples=4), ir.Tessellation(), ir.Tessellation(spacing=1.0, max_level=64, split=False)]
    return [drawn("rasterized and tessellated voxels", [VoxelPicture(voxelize=way) for way in ways])]


def chart(records: ir.Records) -> Figure:
    table = records.table
    cracked = table["stage.compare.cracked"] / table["stage.compare.seen"]
    shown = [(f"{name}\n{cracked[i]:.2%} of the pixels see through", as_colour(picture(records, i))) for i, name in enumerate(NAMES)]
    return panels(shown, columns=3)
