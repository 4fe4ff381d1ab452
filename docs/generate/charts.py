"""Cost and error against a technique's main knob, drawn from what was measured."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from docs.generate.measured import Curve
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure, theme_of

MOST = 4  # kinds of work in one chart: those that change most
NO_WORK = ("stray texels", "covered pixels", "uncovered pixels", "reused caches", "surface points")  # counts of what came out


def changing(curve: Curve) -> dict[str, np.ndarray[Any, Any]]:
    """Kinds of work that the knob changes by more than a twentieth, relative to the default, and the time."""
    index = curve.values.index(curve.default)
    relative = {name: np.array(amount) / amount[index] for name, amount in curve.work.items() if amount[index] > 0}
    moved = {name: amount for name, amount in relative.items() if np.ptp(amount) > 0.05 and not name.endswith(NO_WORK)}
    times = {name: amount for name, amount in moved.items() if name.endswith("time")}
    counts = sorted((name for name in moved if name not in times), key=lambda name: -np.ptp(moved[name]))[: MOST - len(times)]
    return {name: moved[name] for name in counts} | times


def chart(curve: Curve, dark: bool) -> Figure:
    figure = new_figure((7.2, 3.2), dark)
    cost, error = figure.subplots(1, 2)
    for index, (name, amount) in enumerate(changing(curve).items()):
        cost.plot(curve.values, amount, label=name, color=COLOURS[index + 1], marker=MARKERS[index + 1], markersize=4, linewidth=1.2)
    if not changing(curve):
        cost.text(0.5, 0.5, "changes no count by 5 %", ha="center", transform=cost.transAxes, color=theme_of(dark)["ink"], fontsize=8)
    level = np.maximum(curve.error, 1e-9)
    error.errorbar(
        curve.values, level, yerr=[np.minimum(curve.spread, 0.9 * level), curve.spread], label="relMSE", color=COLOURS[0], marker="o",
        markersize=4, linewidth=1.2, capsize=2, elinewidth=0.8,
    )  # fmt: skip
    error.axhline(curve.noise, color=theme_of(dark)["faint"], linestyle=":", linewidth=0.9, label="the truth's noise")
    error.set_yscale("log")
    for ax, label in ((cost, "relative to the default"), (error, "relMSE of the light compared")):
        _dress(ax, curve, label, dark)
    add_legend(figure, (cost, error), dark)
    return figure


def _dress(ax: Any, curve: Curve, label: str, dark: bool) -> None:
    spread = min(curve.values) > 0 and max(curve.values) / min(curve.values) > 4
    if spread:
        ax.set_xscale("log")
    ax.set_xticks(curve.values, labels=[f"{value:g}" for value in curve.values])
    ax.minorticks_off()
    ax.axvline(curve.default, color=theme_of(dark)["faint"], linewidth=0.6)
    ax.set(xlabel=curve.knob, ylabel=label)
    dress(ax, dark)


def write(curve: Curve, stem: Path) -> None:
    """`stem`-light.svg and `stem`-dark.svg."""
    stem.parent.mkdir(parents=True, exist_ok=True)
    for theme in ("light", "dark"):
        chart(curve, theme == "dark").savefig(stem.with_name(f"{stem.name}-{theme}.svg"), metadata={"Date": None})
