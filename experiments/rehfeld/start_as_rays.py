"""4: Starting with ray marching costs the speed-up at small angles without gain in precision."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.pipeline import rehfeld
from experiments.shared.panels import table_figure
from experiments.shared.scenes import phong_sponza

ANGLES = (2.0, 5.0, 15.0)  # half, degrees
STARTS = ("compromise", "rays", "immediate")


def studies() -> Sequence[ir.Study]:
    """Glossy cones alone, at every pixel."""
    ways = [rehfeld(glossy=ir.GlossyCone(half_angle=angle, start=start), share=ir.EveryPixel()) for angle in ANGLES for start in STARTS]
    return [
        ir.Study(
            name="Rehfeld: how cones start", scenes=[phong_sponza(50)], cameras=["nave"], methods=ways, size=(320, 180), bounces=1,
            reference=ir.Reference(noise=1e-2, max_spp=256), repeats=0,
        )
    ]  # fmt: skip


def table(records: ir.Records) -> pd.DataFrame:
    """Steps and error of the glossy cones, a row per half angle, a column per start."""
    return records.table.pivot_table(
        index="glossy.half_angle", columns="glossy.start", values=["stage.glossy.cone_steps", "indirect_relmse"]
    )


def chart(records: ir.Records) -> Figure:
    found = table(records)
    shown = found.copy()
    shown["stage.glossy.cone_steps"] /= 1e6
    shown = shown.rename(columns={"stage.glossy.cone_steps": "million steps", "indirect_relmse": "relMSE"}).rename(
        index=lambda a: f"half angle {a:g}"
    )
    return table_figure(shown, "cones that start with 3/4 voxel (compromise), as rays up to one voxel, and at once")
