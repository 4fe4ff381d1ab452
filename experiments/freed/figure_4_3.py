"""Figure 4.3: Voxels without conservative rasterization, with multisampling, and with full conservative rasterization."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture

NAMES = ("no conservative rasterization", "multisampling, 4 samples", "multisampling, 8 samples", "full conservative rasterization")


def studies() -> Sequence[ir.Study]:
    ways = [ir.Rasterization(samples=1), ir.Rasterization(samples=4), ir.Rasterization(samples=8), ir.Rasterization(conservative="full")]
    return [drawn("conservative rasterization", [VoxelPicture(voxelize=way) for way in ways])]


def chart(records: ir.Records) -> Figure:
    table = records.table
    shown = []
    for i, name in enumerate(NAMES):
        cracked = table["stage.compare.cracked"][i] / table["stage.compare.seen"][i]
        shown.append((f"{name}\n{table['stage.compare.voxels'][i]:,} voxels, {cracked:.2%} of the pixels see through", picture(records, i)))
    return panels([(name, as_colour(image)) for name, image in shown], columns=2)
