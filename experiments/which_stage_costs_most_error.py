"""Which stage of each method costs most error? Every stage is replaced by its exact counterpart, alone and last, on scenes of all kinds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.contenders import SMOOTH_SKY
from experiments.shared.places import Place, of_all_kinds
from interreflect.charts.style import COLOURS, dress, new_figure
from interreflect.study.uncertainty import mean_interval

SIZE, SEEDS, SAMPLES = (80, 45), (0, 1, 2), 64
REFERENCE = ir.Reference(noise=1e-3, max_spp=1024)
METHODS: Mapping[str, Any] = {
    "cones": ir.methods.VoxelConeTracing(),
    "clustered caches": ir.methods.ClusteredRadianceCaching(),
    "virtual area lights": ir.methods.VirtualAreaLights(sky=SMOOTH_SKY),
    "composition": ir.methods.IlluminanceComposition(sky=SMOOTH_SKY),
}
LEAST = 0.02  # of the error: a stage whose mean share is smaller is not drawn


def measure(folder: Path, where: Sequence[Place] | None = None, methods: Mapping[str, Any] = METHODS) -> pd.DataFrame:
    """A row per scene, method and stage: `share` of the method's error, and `status`; "rest" is what stays with every counterpart."""
    rows = []
    for place in of_all_kinds() if where is None else where:
        scene = place.make()
        for name, method in methods.items():
            kept = folder / f"{place.name}_{name}".replace("/", "_").replace(" ", "_")
            found = ir.attribute(method, scene, size=SIZE, seeds=SEEDS, samples=SAMPLES, reference=REFERENCE, folder=kept)
            rows += [{"scene": place.name, "method": name, **row} for row in shares(found)]
    return pd.DataFrame(rows)


def shares(found: Any) -> list[dict[str, Any]]:
    """Of the stages, and what no single stage owns."""
    of_stages = [{"stage": one.stage, "share": one.error, "status": one.status} for one in found.stages]
    return [*of_stages, *({"stage": name, "share": getattr(found, name), "status": ""} for name in ("interaction", "rest"))]


def summary(found: pd.DataFrame) -> pd.DataFrame:
    """A row per method and stage: mean share of the error over scenes with its 95 % interval, largest first."""
    rows = []
    for (method, stage), group in found.dropna(subset="share").groupby(["method", "stage"], sort=False):
        low, high = mean_interval(list(group["share"]))
        rows.append({"method": method, "stage": stage, "share": group["share"].mean(), "low": low, "high": high, "scenes": len(group)})
    return pd.DataFrame(rows).sort_values(["method", "share"], ascending=[True, False], ignore_index=True)


def chart(found: pd.DataFrame) -> Figure:
    """A panel per method: the stages' shares, dots for scenes, means with intervals. Below 0 a stage hides another's error."""
    table = summary(found)
    methods = list(dict.fromkeys(found["method"]))
    figure = new_figure((4.2 * len(methods), 3.2), dark=False)
    for axes, method, colour in zip(figure.subplots(1, len(methods), squeeze=False)[0], methods, COLOURS, strict=False):
        drawn = table[(table["method"] == method) & (table["share"].abs() >= LEAST)]
        for y, (_, row) in enumerate(drawn.iterrows()):
            every = found[(found["method"] == method) & (found["stage"] == row["stage"])]["share"].dropna()
            axes.plot(every, [y] * len(every), ".", color=colour, alpha=0.6)
            axes.errorbar(
                [row["share"]], [y], xerr=[[row["share"] - row["low"]], [row["high"] - row["share"]]], fmt="o", color="black", capsize=3
            )
        axes.axvline(0, color="grey", linewidth=0.8)
        axes.set_yticks(range(len(drawn)), drawn["stage"])
        axes.invert_yaxis()
        axes.set(title=method, xlabel="share of the method's relMSE", ylabel="")
        dress(axes, dark=False)
    return figure


def told(found: pd.DataFrame) -> str:
    """The finding in words: each method's costliest stages, with intervals over scenes."""
    table = summary(found)
    lines = []
    for method, rows in table.groupby("method", sort=False):
        first = [f"{row.stage} {row.share:.2f} [{row.low:.2f}, {row.high:.2f}]" for row in rows.head(3).itertuples()]
        lines.append(f"{method}, over {rows['scenes'].max()} scenes: {'; '.join(first)}")
    return "\n".join(lines)
