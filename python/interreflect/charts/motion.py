"""Charts of methods in motion: curves over the frames, and filmstrips."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from interreflect import metrics
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.stability.temporal import Played


def curves(played: Sequence[Played], dark: bool = False) -> Figure:
    """Temporal error (mean, and 99th percentile dashed) and relMSE over the frames, a colour per method."""
    from matplotlib.ticker import MaxNLocator

    figure = new_figure((9.0, 3.6), dark)
    left, right = figure.subplots(1, 2)
    for k, one in enumerate(played):
        table, colour = one.table, COLOURS[k % len(COLOURS)]
        style = {"color": colour, "marker": MARKERS[k % len(MARKERS)], "markersize": 3.5, "linewidth": 1.2}
        left.plot(table.index, table["temporal_mean"], label=one.method, **style)
        left.plot(table.index, table["temporal_p99"], color=colour, linestyle="--", linewidth=0.9)
        right.plot(table.index, table["relmse"], **style)
    noise = max(one.truth_jumps.mean for one in played)
    if noise > 0:
        left.axhline(noise, color=theme_of(dark)["faint"], linewidth=0.8, linestyle=":", label="the truth's own noise")
    for axes, label in ((left, "temporal error, share of mean radiance"), (right, "relMSE of the frame")):
        axes.set_yscale("log")
        axes.set(xlabel="frame", ylabel=label)
        axes.xaxis.set_major_locator(MaxNLocator(integer=True))
        dress(axes, dark)
    left.set_title("mean, and 99th percentile dashed", fontsize=9)
    add_legend(figure, [left], dark)
    return figure


def filmstrip(played: Played, frames: int = 6, dark: bool = False) -> Figure:
    """Pictures above their truth above the temporal error of evenly spaced frames; one scale of errors ends at the 99th percentile."""
    shown = np.unique(np.linspace(0, len(played.images) - 1, frames).round().astype(int))
    height, width = played.images[0].shape[:2]
    figure = new_figure((1.9 * len(shown) + 0.6, 3 * 1.9 * height / width + 0.9), dark)
    grid = figure.subplots(3, len(shown), squeeze=False)
    highest = max(played.p99, 1e-6)
    mapped = None
    for column, k in enumerate(shown):
        for row, image in enumerate((played.images[k], played.truths[k])):
            grid[row, column].imshow(metrics.tone_map(image, played.truths[0]))
        if k:
            mapped = grid[2, column].imshow(played.errors[k - 1], cmap="magma", vmin=0, vmax=highest)
        grid[0, column].set_title(f"frame {k}", fontsize=8, color=theme_of(dark)["ink"])
    for axes in grid.flat:
        axes.set_axis_off()
    for row, name in enumerate((played.method, "truth", "temporal error")):
        grid[row, 0].text(-0.04, 0.5, name, transform=grid[row, 0].transAxes, rotation=90, ha="right", va="center", fontsize=7,
                          color=theme_of(dark)["ink"])  # fmt: skip
    if mapped is not None:
        bar = figure.colorbar(mapped, ax=list(grid[2]), location="bottom", shrink=0.5, extend="max")
        bar.set_label("share of mean radiance; not seen before: blank", fontsize=7, color=theme_of(dark)["ink"])
        bar.ax.tick_params(colors=theme_of(dark)["ink"], labelsize=7)
    return figure
