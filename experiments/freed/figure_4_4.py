"""Figure 4.4: Voxels of the tessellation-based approach."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_colour, panels, picture
from experiments.shared.voxel_picture import VoxelPicture


def studies() -> Sequence[ir.Study]:
    return [drawn("tessellated voxels", [VoxelPicture(voxelize=ir.Tessellation())])]


def chart(records: ir.Records) -> Figure:
    return panels([("tessellated, 256^3", as_colour(picture(records)))], width=6.4)
