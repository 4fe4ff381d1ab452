"""Figure 4.1: Voxels of the rasterization-based approach, without conservative rasterization."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture


def studies() -> Sequence[ir.Study]:
    return [drawn("rasterized voxels", [VoxelPicture(voxelize=ir.Rasterization(samples=1))])]


def chart(records: ir.Records) -> Figure:
    return panels([("rasterized at voxel centres, 256^3", as_colour(picture(records)))], width=6.4)
