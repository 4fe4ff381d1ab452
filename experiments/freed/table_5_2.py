"""Table 5.2: Time of voxelizing, rasterized and tessellated, against the size of the grid."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import freed, timed
from experiments.shared.panels import table_figure

RESOLUTIONS = (64, 128, 256)


def studies() -> Sequence[ir.Study]:
    """Small pictures: voxelizing does not depend on their size."""
    ways = [
        freed(voxelize=way, grid__resolution=n, glossy=None)
        for way in (ir.Rasterization(samples=4), ir.Tessellation())
        for n in RESOLUTIONS
    ]
    return [timed("both voxelizations", ways, (160, 90))]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per size of the grid, a column per way to voxelize."""
    return records.table.pivot_table(index="grid.resolution", columns="voxelize", values="stage.voxelize.milliseconds")


def chart(records: ir.Records) -> Figure:
    shown = table(records).rename(index=lambda n: f"{n}^3")
    return table_figure(shown, "milliseconds to voxelize Sponza (medians)")
