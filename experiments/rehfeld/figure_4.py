"""Figure 4: What each step of a frame costs, as a bar: two million pixels, ten suns, 4,096 caches."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching
from experiments.rehfeld.sites import by_site, everywhere
from experiments.shared.two_cars import SIZE
from interreflect.charts.style import COLOURS, dress, new_figure

# The paper's steps, milliseconds on a GTX 670, and the stages that do their work here. Its voxels are made in advance.
PAPER = {"G-buffer": 11.0, "voxel shading": 27.0, "distribution": 31.0, "creation": 39.0, "evaluation": 33.5, "direct light": 88.0}
STAGES = {
    "G-buffer": ["gbuffer"],
    "voxel shading": ["light_voxels", "prefilter"],
    "distribution": ["distribute"],
    "creation": ["fill", "preconvolve"],
    "evaluation": ["interpolate"],
    "direct light": ["shadow", "sky", "shade"],
}
STAGGER = 0.2  # of a bar's place: numbers stand high and low in turn, as neighbours are narrower than they

PAPER_PRINTS = "in the chart's last bar: milliseconds on a GTX 670"


def studies() -> Sequence[ir.Study]:
    return everywhere("times of the steps", [caching(shadow=ir.VoxelCones())], size=SIZE, repeats=5)


def table(*records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per step; a column per site, and `paper`."""
    return pd.DataFrame({site: _steps(one) for site, (one,) in by_site(records).items()} | {"paper": PAPER})


def _steps(records: ir.Records) -> dict[str, float]:
    row = records.table.iloc[0]
    return {name: sum(float(row[f"stage.{stage}.milliseconds"]) for stage in stages) for name, stages in STAGES.items()}


def chart(*records: ir.Records) -> Figure:
    times = table(*records)
    figure = new_figure((8.0, 3.0), dark=False)
    axes = figure.subplots()
    for place, column in enumerate(times):
        left = 0.0
        for k, (colour, (step, value)) in enumerate(zip(COLOURS, times[column].items(), strict=False)):
            share = value / times[column].sum()
            axes.barh(place, share, left=left, color=colour, label=step if place == 0 else None)
            height = place + (STAGGER if k % 2 else -STAGGER)
            axes.text(left + share / 2, height, f"{value:.0f}", ha="center", va="center", fontsize=8, color="white")
            left += share
    names = {name: "paper (GTX 670)" if name == "paper" else name for name in times}
    axes.set_yticks(range(len(names)), [f"{names[name]}, {total:.0f} ms" for name, total in times.sum().items()])
    axes.invert_yaxis()
    axes.set(xlabel="share of the frame; numbers: milliseconds", xlim=(0, 1))
    dress(axes, dark=False)
    figure.legend(loc="outside lower center", ncols=6, fontsize=8, frameon=False)
    return figure
