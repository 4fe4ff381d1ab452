"""What does each scene need, and what is wasted on it? The ladder of mechanisms on every scene: which of them lower the error beyond noise,
and what the others cost."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.places import Place, places
from interreflect.charts.style import new_figure
from interreflect.study.uncertainty import mean_interval

SIZE = (160, 90)
REFERENCE = ir.Reference(noise=1e-3, max_spp=1024)
LARGE = 0.1  # of what the rungs below left: a gain that would be seen


def measure(folder: Path, where: Sequence[Place] | None = None) -> pd.DataFrame:
    """A row per scene and mechanism: `error` with it, `gain` over the rungs below, `needed`, `milliseconds`, and what would remain were it
    exact (`exact_error`)."""
    tables = []
    for place in places().values() if where is None else where:
        kept = folder / place.name.replace("/", "_").replace(" ", "_")
        ladder = ir.ladder(place.make(), size=SIZE, reference=REFERENCE, folder=kept)
        tables.append(ladder.table.assign(scene=place.name, stopped=ladder.stopped))
    return pd.concat(tables, ignore_index=True)


def relative(found: pd.DataFrame) -> pd.DataFrame:
    """Gain as a share of the error that was left below, scene by mechanism; NaN for the lowest rung and where a ladder had stopped."""
    rows = found.assign(share=found["gain"] / (found["gain"] + found["error"]).clip(lower=1e-12))
    order = list(dict.fromkeys(found["mechanism"]))
    return rows.pivot(index="scene", columns="mechanism", values="share")[order].reindex(list(dict.fromkeys(found["scene"])))


def chart(found: pd.DataFrame) -> Figure:
    """Scene by mechanism: the share of the error below that it removes; grey: the ladder had stopped; "-": not needed."""
    shares = relative(found).iloc[:, 1:]
    needed = found.pivot(index="scene", columns="mechanism", values="needed")
    figure = new_figure((2.6 + 1.0 * shares.shape[1], 1.6 + 0.25 * len(shares)), dark=False)
    axes = figure.subplots()
    axes.set_facecolor("#dddddd")
    axes.imshow(shares.to_numpy(float), cmap="RdYlGn", vmin=-1, vmax=1, aspect="auto")
    for y, (scene, row) in enumerate(shares.iterrows()):
        for x, (mechanism, share) in enumerate(row.items()):
            if np.isfinite(share):
                axes.text(x, y, f"{share:.2f}" if needed.loc[scene, mechanism] else f"- {share:.2f}", ha="center", va="center", fontsize=6)
    axes.set_xticks(range(shares.shape[1]), shares.columns, fontsize=7, rotation=30, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(shares)), shares.index, fontsize=7)
    axes.set(xlabel="mechanism, from the lowest rung up", ylabel="scene")
    return figure


def told(found: pd.DataFrame) -> str:
    """The finding in words: how often each mechanism is needed, what it gains there, and what it costs where it is not."""
    lines = []
    for mechanism, rows in found.groupby("mechanism", sort=False):
        needed, wasted = rows[rows["needed"]], rows[~rows["needed"]]
        lines.append(f"{mechanism}: needed on {len(needed)} of {len(rows)} scenes{_gain(needed)}{_waste(wasted)}")
    return "\n".join(lines)


def _gain(needed: pd.DataFrame) -> str:
    shares = (needed["gain"] / (needed["gain"] + needed["error"]).clip(lower=1e-12)).dropna()
    if shares.empty:
        return ""
    low, high = mean_interval(list(shares))
    often = int((shares > LARGE).sum())
    return f", where it removes {shares.mean():.2f} [{low:.2f}, {high:.2f}] of the error left, on {often} of them more than {LARGE}"


def _waste(wasted: pd.DataFrame) -> str:
    extra: Any = wasted["extra_milliseconds"].dropna()
    return f"; {extra.median():.0f} ms more for nothing on the others (median)" if len(extra) else ""
