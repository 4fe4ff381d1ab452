"""Charts of an attribution: each stage's share of error and time, and what its approximation changes in the picture."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from interreflect import metrics
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

    from interreflect.study.attribution import Attribution

CHANGE_RANGE = 0.5  # of the truth's value: where the colours of a difference end


def shares(found: Attribution, dark: bool = False) -> Figure:
    """Two panels side by side: share of error per stage (bar: the share, dots: alone and added) and share of time."""
    from interreflect.study.attribution import MEASURED, WITHIN_NOISE

    table = found.table[found.table["stage"] != "(whole)"]
    places = np.arange(len(table))
    figure = new_figure((9.5, 1.4 + 0.3 * len(table)), dark)
    errors, times = figure.subplots(1, 2, sharey=True)
    ink = theme_of(dark)["ink"]
    measured = table["status"].isin(MEASURED) | table["stage"].str.startswith("(")
    faint = np.where(table["note"] == WITHIN_NOISE, 0.35, 1.0)
    for place, (_, row), alpha in zip(places, table.iterrows(), faint, strict=True):
        errors.barh(place, 100 * row["error"] if measured.iloc[place] else 0, color=COLOURS[0], alpha=alpha, height=0.65)
        if not measured.iloc[place]:
            errors.annotate(row["status"], (0, place), xytext=(4, 0), textcoords="offset points", va="center", fontsize=7, color=ink)
    spread = [100 * (table["error"] - table["low"]), 100 * (table["high"] - table["error"])]
    errors.errorbar(100 * table["error"], places, xerr=np.nan_to_num(spread), fmt="none", ecolor=ink, elinewidth=0.9, capsize=2)
    errors.plot(100 * table["alone"], places - 0.12, "o", markersize=4, color=COLOURS[1], label="vanishes when it alone is exact")
    errors.plot(100 * table["added"], places + 0.12, "D", markersize=3.5, color=COLOURS[2], label="it adds where all others are exact")
    errors.axvline(0, color=theme_of(dark)["faint"], linewidth=0.8)
    times.barh(places, 100 * table["time"].fillna(0), color=COLOURS[3], height=0.65)
    errors.set_yticks(places, table["stage"])
    errors.invert_yaxis()
    errors.set(xlabel=f"share of {found.metric} ({found.error:.2g}), %; line: 95 % interval over seeds")
    times.set(xlabel=f"share of the frame ({found.milliseconds:.3g} ms), %")
    for ax in (errors, times):
        dress(ax, dark).grid(axis="y", visible=False)
    times.tick_params(labelleft=False)
    figure.suptitle(f"{found.method.name}: {found.scene.name}, {found.camera}", fontsize=10, color=ink)
    add_legend(figure, [errors], dark)
    return figure


def differences(found: Attribution, dark: bool = False) -> Figure:
    """Truth, the method, its difference from the truth, and for each stage the method minus the method with that stage exact."""
    from interreflect.study.attribution import AS_IS, MEASURED

    truth, image = found.truth(), found.image(AS_IS)
    stages = [stage for stage in found.stages if stage.status in MEASURED]
    height, width = truth.shape[:2]
    figure = new_figure((2.3 * (3 + len(stages)), 2.3 * height / width + 1.3), dark)
    axes = list(figure.subplots(1, 3 + len(stages), squeeze=False).flat)
    for ax, picture, title in ((axes[0], truth, "truth"), (axes[1], image, f"{found.method.name}\n{found.metric} {found.error:.2g}")):
        ax.imshow(metrics.tone_map(picture, truth))
        ax.set_title(title, fontsize=8)
    shown = _difference(axes[2], image - truth, truth, "method - truth")
    for ax, stage in zip(axes[3:], stages, strict=True):
        share = stage.note or f"{stage.error:.0%} of the error"
        _difference(ax, image - found.image(stage.stage), truth, f"{stage.stage}\n{share}")
    for ax in axes:
        ax.set_axis_off()
        ax.title.set_color(theme_of(dark)["ink"])
    bar = figure.colorbar(shown, ax=axes, location="bottom", shrink=0.4, aspect=50, extend="both", pad=0.03)
    bar.set_label("brighter (red) or darker (blue) through the approximation, share of the truth", fontsize=8, color=theme_of(dark)["ink"])
    bar.ax.tick_params(colors=theme_of(dark)["ink"], labelsize=7)
    return figure


def _difference(ax: Axes, change: metrics.Image, truth: metrics.Image, title: str) -> AxesImage:
    below = np.sqrt(truth.astype(np.float64) ** 2 + metrics.epsilon(truth))
    relative = np.divide(change, below, out=np.zeros_like(below), where=below > 0).mean(axis=2)
    ax.set_title(title, fontsize=8)
    return ax.imshow(relative, cmap="RdBu_r", vmin=-CHANGE_RANGE, vmax=CHANGE_RANGE)
