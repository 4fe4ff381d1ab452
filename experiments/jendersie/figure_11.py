"""Figure 11: Frame time against bands, with links in spherical harmonics and with run-time projection."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import FULL, composition, milliseconds, projected, study
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure

BANDS = tuple(range(2, 9))
KINDS = ("SH links", "run-time projection")
STEPS = {
    "surfel lighting and pull": ("light_surfels", "pull"),
    "cache lighting": ("light_caches",),
    "evaluation": ("evaluate",),
    "all else": ("gbuffer", "shadow", "sky", "shade"),
}
# Milliseconds of cache lighting on a GTX 980 with projection, where the paper tells them.
PAPER = {2: 0.78, 3: 0.99, 4: 1.02, 5: 1.29, 6: 1.31, 8: 1.95}


def studies() -> Sequence[ir.Study]:
    ways = [*(composition(link__bands=bands) for bands in BANDS), *(projected(link__bands=bands) for bands in BANDS)]
    return [study("bands with both kinds of links", ways, size=FULL, repeats=3, images=False)]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per kind of links and number of bands, a column per step."""
    rows = {}
    for i, (kind, bands) in enumerate((kind, bands) for kind in KINDS for bands in BANDS):
        rows[kind, bands] = {step: milliseconds(records, i, stages) for step, stages in STEPS.items()}
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    times = table(records)
    figure = new_figure((7.0, 3.4), dark=False)
    axes = figure.subplots()
    for place, kind in enumerate(KINDS):
        x = np.array(BANDS) + 0.4 * place - 0.2
        below = np.zeros(len(BANDS))
        for (step, column), colour in zip(times.loc[kind].items(), COLOURS, strict=False):
            axes.bar(x, column, 0.36, bottom=below, color=colour, label=step if place == 0 else None)
            below += column.to_numpy()
        for left, top in zip(x, below, strict=True):
            axes.text(left, top, "SH" if place == 0 else "RTP", ha="center", va="bottom", fontsize=6)
    axes.set(xlabel="bands", ylabel="frame, milliseconds")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
