"""Do precomputed caches beat clustered caches, virtual area lights and cones at equal time? One bounce, with what is precomputed on its
own axis: errors against a frame's time, and against what must be done before the first one."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.with_precomputation import methods, scenes
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

study = ir.Study(
    name="do precomputed caches beat rivals at equal time?",
    scenes=scenes(),
    methods=methods(),
    size=(320, 180),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=1024),
    repeats=5,
    max_repeats=5,
    images=True,
)

BUDGETS = (20, 50, 100, 200)  # ms
AXES = {"milliseconds": "frame, ms (median)", "precompute_milliseconds": "precomputation, ms"}


def winners(records: ir.Records) -> Any:
    """Within each budget of a frame, every method's most accurate setting and what it took to precompute."""
    import pandas as pd

    found = [ir.equal_time(records, milliseconds=budget, y="indirect_relmse").assign(budget=budget) for budget in BUDGETS]
    return pd.concat(found)[["scene", "budget", "method", "milliseconds", "precompute_milliseconds", "indirect_relmse", "note"]]


def chart(records: ir.Records) -> Figure:
    """A row per scene: indirect relMSE against the frame's time and against the precomputation's, a colour per method."""
    table = records.table[records.table["status"] == "ok"]
    rows = list(table.groupby("scene", sort=False))
    figure = new_figure((9.0, 3.4 * len(rows)), dark=False)
    panels = figure.subplots(len(rows), len(AXES), squeeze=False)
    for line, (scene, points) in zip(panels, rows, strict=True):
        for axes, (x, label) in zip(line, AXES.items(), strict=True):
            for (name, of), colour, marker in zip(points.groupby("method", sort=False), COLOURS, MARKERS, strict=False):
                axes.plot(of[x], of["indirect_relmse"], marker, color=colour, markersize=4, label=str(name))
                if x == "milliseconds":
                    best = of.sort_values(x)
                    axes.step(best[x], best["indirect_relmse"].cummin(), where="post", color=colour, linewidth=0.8)
            axes.axhline(points["indirect_noise"].max(), color="grey", linestyle=":", linewidth=0.8, label="the truth's noise")
            axes.set(title=scene, xscale="log", yscale="log", xlabel=label, ylabel="indirect relMSE")
            dress(axes, dark=False)
    add_legend(figure, panels.flat, dark=False)
    return figure
