"""Table 5.1: Time of each pass at three sizes of picture and three of the grid, tessellated."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import freed, timed
from experiments.shared.panels import table_figure

SIZES = ((1280, 720), (1600, 900), (1920, 1080))
RESOLUTIONS = (64, 128, 256)
# The paper's passes and the stages that do their work here. Its depth prepass is the G-buffer.
PASSES = {
    "voxelize": ["voxelize"],
    "shadow map and radiance injection": ["light_voxels"],
    "radiance filtering": ["prefilter"],
    "G-buffer": ["gbuffer"],
    "final shading": ["march", "glossy", "shadow", "sky", "shade"],
}


def studies() -> Sequence[ir.Study]:
    ways = [freed(voxelize=ir.Tessellation(spacing=1.0, split=False), grid__resolution=n) for n in RESOLUTIONS]
    return [timed("times of the passes", ways, size) for size in SIZES]


def table(*records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per pass, a column per size of picture and grid."""
    columns = {}
    for one in records:
        for _, row in one.table.iterrows():
            times = {name: sum(row.get(f"stage.{stage}.milliseconds", 0.0) for stage in made_of) for name, made_of in PASSES.items()}
            columns[f"{row['width']} x {row['height']}", f"{row['grid.resolution']}^3"] = {**times, "total": row["milliseconds"]}
    return pd.DataFrame(columns)


def chart(*records: ir.Records) -> Figure:
    return table_figure(table(*records), "milliseconds a frame (medians)")
