"""How many frames of moving light repay the precomputation? A light that moves costs illuminance composition a frame and nothing else; each
of its settings is held against what is fastest, frame by frame, among the rivals that are at least as accurate."""

from __future__ import annotations

import dataclasses
from itertools import product

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.do_caches_beat_rivals_at_equal_time import study as rivals_study
from experiments.shared.with_precomputation import COMPOSITION
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

study = dataclasses.replace(rivals_study, name="how many frames of moving light repay the precomputation?")

AT_ONCE, NEVER = 1.0, 1e6  # frames: where a chart puts what no rival reaches, and what a rival beats in every frame


def repaid(records: ir.Records) -> pd.DataFrame:
    """Frames after which a setting has taken less time in all than each rival's fastest setting with no larger indirect relMSE; `inf`
    where that is never; NaN where the rival has no such setting. A row per scene, setting and rival."""
    table = records.table[records.table["status"] == "ok"]
    rows = []
    for scene, points in table.groupby("scene", sort=False):
        rivals = points[points["method"] != COMPOSITION]
        for (_, ours), name in product(points[points["method"] == COMPOSITION].iterrows(), rivals["method"].unique()):
            as_good = rivals[(rivals["method"] == name) & (rivals["indirect_relmse"] <= ours["indirect_relmse"])]
            frames = np.nan
            if len(as_good) > 0:
                theirs = as_good.loc[as_good["milliseconds"].idxmin()]
                saved = theirs["milliseconds"] - ours["milliseconds"]
                before = ours["precompute_milliseconds"] - theirs["precompute_milliseconds"]
                frames = max(before / saved, AT_ONCE) if saved > 0 else np.inf
            rows.append({"scene": scene, "rival": name, "error": ours["indirect_relmse"], "frames": frames,
                         "milliseconds": ours["milliseconds"], "precomputation": ours["precompute_milliseconds"]})  # fmt: skip
    return pd.DataFrame(rows)


def chart(records: ir.Records) -> Figure:
    """Frames until the precomputation is repaid against the error that both keep, a panel per scene and a colour per rival."""
    found = repaid(records)
    panels = list(found.groupby("scene", sort=False))
    figure = new_figure((4.6 * len(panels), 3.6), dark=False)
    drawn = figure.subplots(1, len(panels), squeeze=False)[0]
    for axes, (scene, rows) in zip(drawn, panels, strict=True):
        for (rival, points), colour, marker in zip(rows.groupby("rival", sort=False), COLOURS, MARKERS, strict=False):
            frames = points["frames"].replace(np.inf, NEVER).fillna(AT_ONCE)
            axes.plot(points["error"], frames, marker, color=colour, markersize=5, label=str(rival))
        axes.axhline(NEVER, color="grey", linestyle=":", linewidth=0.8, label="never: the rival's frames are faster")
        axes.axhline(AT_ONCE, color="grey", linestyle="--", linewidth=0.8, label="no setting of the rival is as accurate")
        axes.set(title=scene, xscale="log", yscale="log", xlabel="indirect relMSE", ylabel="frames that repay the precomputation")
        dress(axes, dark=False)
    add_legend(figure, drawn, dark=False)
    return figure
