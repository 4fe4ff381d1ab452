"""Table 2: Milliseconds of the steps of a frame with both of the paper's settings."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import FULL, composition, milliseconds, precomputed, study
from experiments.shared.panels import table_figure

SETTINGS = ("setting 1", "setting 2")
# The paper's steps and the stages that do their work here. Shadows are traced, so there are no maps; shading holds direct light too.
STEPS = {
    "surfel lighting": ("light_surfels",),
    "pull": ("pull",),
    "cache lighting": ("light_caches",),
    "shading": ("gbuffer", "evaluate", "shadow", "sky", "shade"),
}
FRAME = "total frame"
# Milliseconds on a GTX 980 (its frame has shadow maps, too) and on an i7-4790S, whose pixels were not shaded.
GPU = {"setting 1": (0.09, 1.72, 2.27, 2.59, 7.17), "setting 2": (0.04, 0.38, 0.58, 1.99, 3.65)}
CPU = {"setting 1": (8.12, 5.0, 116.0, float("nan"), 131.0), "setting 2": (4.87, 1.13, 11.5, float("nan"), 21.1)}

PAPER_PRINTS = "in the table: milliseconds on a GTX 980 and an i7-4790S"


def studies() -> Sequence[ir.Study]:
    return [study("both settings", [composition(name) for name in SETTINGS], size=FULL, repeats=5, images=False)]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per step; columns (setting, ours, GTX 980 or i7-4790S)."""
    columns = {}
    for i, name in enumerate(SETTINGS):
        ours = [milliseconds(records, i, stages) for stages in STEPS.values()]
        for machine, times in (("ours", (*ours, records[i].milliseconds)), ("GTX 980", GPU[name]), ("i7-4790S", CPU[name])):
            columns[name, machine] = dict(zip([*STEPS, FRAME], times, strict=True))
    return pd.DataFrame(columns)


def chart(records: ir.Records) -> Figure:
    counts = (precomputed(records, i) for i in range(len(SETTINGS)))
    told = "; ".join(
        f"{name}: {one['caches']:,} caches, {one['links']} links, {one['surfels']:,} surfels"
        for name, one in zip(SETTINGS, counts, strict=True)
    )
    return table_figure(table(records), f"milliseconds, {FULL[0]} x {FULL[1]} (medians; the paper: 10,585 caches)\n{told}")
