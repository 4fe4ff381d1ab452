"""Figure 5.4: Cracks where the fragments' resolution is too low for the density of the voxels."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture

SHARES = (0.5, 1.0)


def studies() -> Sequence[ir.Study]:
    ways = [ir.Rasterization(samples=4, oversampling=share) for share in SHARES]
    return [drawn("fragments coarser than voxels", [VoxelPicture(voxelize=way) for way in ways])]


def chart(records: ir.Records) -> Figure:
    return panels([(f"{share:g} fragments a voxel's edge", as_colour(picture(records, i))) for i, share in enumerate(SHARES)])
