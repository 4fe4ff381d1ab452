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
STARTS = {  # name -> knobs of the cone
    "compromise": {"start": "opening", "first_diameter": 0.75},
    "rays": {"start": "rays", "first_diameter": 0.75},
    "immediate": {"start": "opening", "first_diameter": 1.0},
}


def studies() -> Sequence[ir.Study]:
    """One angle for all glossy cones, one at every pixel."""
    cone = rehfeld().glossy
    ways = [rehfeld(glossy=cone.replace(half_angle=angle, **start)) for angle in ANGLES for start in STARTS.values()]
    return [
        ir.Study(
            name="Rehfeld: how cones start",
            scenes=[phong_sponza(50)],
            cameras=["nave"],
            methods=ways,
            size=(320, 180),
            bounces=1,
            reference=ir.Reference(noise=1e-2, max_spp=256),
            repeats=0,
        )
    ]


def table(records: ir.Records) -> pd.DataFrame:
    """Steps and error of the glossy cones: a row per half angle, a column per way to start."""
    named = records.table.assign(start=[name for _ in ANGLES for name in STARTS])
    found = named.pivot_table(index="glossy.half_angle", columns="start", values=["stage.glossy.cone_steps", "indirect_relmse"])
    return found.rename(columns={"stage.glossy.cone_steps": "steps", "indirect_relmse": "error"})


def chart(records: ir.Records) -> Figure:
    found = table(records)
    found["steps"] /= 1e6
    shown = found.rename(columns={"steps": "million steps", "error": "relMSE"}).rename(index=lambda angle: f"half angle {angle:g}")
    return table_figure(shown, "cones that start 3/4 voxel wide (compromise), as rays up to one voxel, and one voxel wide at once")
