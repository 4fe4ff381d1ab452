"""Table 5.2: Time of voxelizing, rasterized and tessellated, against the size of the grid."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import freed, timed
from experiments.shared.panels import table_figure

RESOLUTIONS = (64, 128, 256)
RASTERIZED, TESSELLATED, CLOSED = "rasterized, 4 samples", "tessellated as printed", "tessellated, no holes"

# Milliseconds on a GTX 970, rows as ours.
GTX_970 = {RASTERIZED: (0.53, 0.85, 1.91), TESSELLATED: (0.70, 1.12, 2.35)}
PAPER_PRINTS = "in the table's last two columns: milliseconds on a GTX 970"


def studies() -> Sequence[ir.Study]:
    """Small pictures: voxelizing does not depend on their size."""
    ways = [ir.Rasterization(samples=4), ir.Tessellation(spacing=1.0, split=False), ir.Tessellation()]
    return [
        timed("both voxelizations", [freed(voxelize=way, grid__resolution=n, glossy=None) for way in ways for n in RESOLUTIONS], (160, 90))
    ]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per size of the grid, a column per way to voxelize."""
    names = [name for name in (RASTERIZED, TESSELLATED, CLOSED) for _ in RESOLUTIONS]
    times = records.table.assign(way=names).pivot_table(index="grid.resolution", columns="way", values="stage.voxelize.milliseconds")
    return times[[RASTERIZED, TESSELLATED, CLOSED]]


def chart(records: ir.Records) -> Figure:
    ours = table(records)
    both = pd.concat({"ours": ours, "GTX 970": pd.DataFrame(GTX_970, RESOLUTIONS)}, axis=1)
    heads = [(*name.split(", "), machine) for machine, name in both.columns]
    shown = both.rename(index=lambda n: f"{n}^3").set_axis(["\n".join(head) for head in heads], axis=1)
    return table_figure(shown, "milliseconds to voxelize Sponza (medians)")
