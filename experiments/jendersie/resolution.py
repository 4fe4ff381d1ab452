"""Resolution: Which steps of a frame take longer with more pixels [5.3.1]."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import composition, milliseconds, study
from experiments.shared.panels import table_figure

SIZES = ((960, 540), (1920, 1080), (3840, 2160))
STEPS = {
    "surfel lighting": ("light_surfels",),
    "pull": ("pull",),
    "cache lighting": ("light_caches",),
    "shading with indirect light": ("gbuffer", "evaluate", "shadow", "sky", "shade"),
    "and without": ("gbuffer", "shadow", "sky"),
}
PAPER = {"shading with indirect light": (0.99, 2.59, 8.84), "and without": (0.67, 1.41, 3.51)}  # milliseconds on a GTX 980

PAPER_PRINTS = (
    "shading on a GTX 980 at 960 x 540, 1920 x 1080, 3840 x 2160: .99, 2.59, 8.84 ms with indirect light, .67, 1.41, 3.51 ms without"
)


def studies() -> Sequence[ir.Study]:
    return [study(f"{width} by {height}", [composition()], size=(width, height), repeats=5, images=False) for width, height in SIZES]


def table(*records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per step; columns (size, ours or GTX 980)."""
    columns = {}
    for place, ((width, height), one) in enumerate(zip(SIZES, records, strict=True)):
        columns[f"{width} x {height}", "ours"] = {step: milliseconds(one, 0, stages) for step, stages in STEPS.items()}
        columns[f"{width} x {height}", "GTX 980"] = {step: times[place] for step, times in PAPER.items()}
    return pd.DataFrame(columns).reindex(list(STEPS))


def chart(*records: ir.Records) -> Figure:
    return table_figure(table(*records), "milliseconds (medians)")
