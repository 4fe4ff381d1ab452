"""Figure 5.5: The final picture with rasterized and with tessellated voxels."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared, freed
from experiments.shared.panels import as_light, panels, picture

NAMES = ("rasterized voxels", "tessellated voxels")


def studies() -> Sequence[ir.Study]:
    return [
        compared("final pictures of both voxelizations", [freed(voxelize=ir.Rasterization(samples=4)), freed(voxelize=ir.Tessellation())])
    ]


def chart(records: ir.Records) -> Figure:
    truth = records.truth(records[0])[0]
    return panels([(name, as_light(picture(records, i), truth)) for i, name in enumerate(NAMES)])
