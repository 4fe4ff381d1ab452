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
# Milliseconds on a GTX 970, in the order of the columns; the shadow map and injecting from it stand in one row here, as in ours.
GTX_970 = {
    "voxelize": (0.90, 1.13, 2.40, 0.70, 1.12, 2.39, 0.72, 1.15, 2.41),
    "shadow map and radiance injection": (1.61, 1.61, 1.62, 1.61, 1.61, 1.62, 1.60, 1.60, 1.62),
    "radiance filtering": (0.04, 0.10, 0.55, 0.05, 0.10, 0.56, 0.04, 0.10, 0.55),
    "G-buffer": (0.20, 0.20, 0.20, 0.25, 0.26, 0.25, 0.31, 0.31, 0.36),
    "final shading": (3.89, 4.81, 5.32, 5.98, 6.42, 7.10, 8.23, 9.40, 9.75),
    "total": (7.02, 8.21, 11.12, 9.46, 10.15, 13.43, 11.23, 12.83, 16.31),
}
PAPER_PRINTS = "in the table's lower half: milliseconds on a GTX 970"


def studies() -> Sequence[ir.Study]:
    ways = [freed(voxelize=ir.Tessellation(spacing=1.0, split=False), grid__resolution=n) for n in RESOLUTIONS]
    return [timed("times of the passes", ways, size) for size in SIZES]


def head(width: int, height: int, resolution: int) -> tuple[str, str]:
    """Of a column."""
    return f"{width} x {height}", f"{resolution}^3"


def table(*records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per pass, a column per size of picture and grid."""
    columns = {}
    for one in records:
        for _, row in one.table.iterrows():
            times = {name: sum(row.get(f"stage.{stage}.milliseconds", 0.0) for stage in made_of) for name, made_of in PASSES.items()}
            columns[head(row["width"], row["height"], row["grid.resolution"])] = {**times, "total": row["milliseconds"]}
    return pd.DataFrame(columns)


def chart(*records: ir.Records) -> Figure:
    ours = table(*records)
    printed = pd.DataFrame(GTX_970, [head(width, height, n) for width, height in SIZES for n in RESOLUTIONS]).T
    both = pd.concat({"ours": ours, "GTX 970": printed.set_axis(pd.MultiIndex.from_tuples(printed.columns), axis=1)})
    return table_figure(both.set_axis([f"{machine}, {name}" for machine, name in both.index]), "milliseconds a frame (medians)")
