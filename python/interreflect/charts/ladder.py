"""The chart of a ladder: error over time from rung to rung, and what would remain if each were exact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from interreflect.charts.style import COLOURS, add_legend, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.study.ladder import Ladder


def staircase(found: Ladder, dark: bool = False) -> Figure:
    """A column per rung: its error with interval (filled where it is needed), every setting's, and exact light's; times above."""
    rungs, ink = found.rungs, theme_of(dark)["ink"]
    places = np.arange(len(rungs))
    figure = new_figure((1.5 + 1.25 * len(rungs), 5.6), dark)
    times, errors = figure.subplots(2, 1, sharex=True, height_ratios=[1, 2])
    floor = max(found.truth_noise, 1e-12)
    spread = np.array([[rung.error - rung.low, rung.high - rung.error] for rung in rungs]).T
    heights = np.maximum([rung.error for rung in rungs], floor / 2)
    spread[0] = np.minimum(spread[0], 0.9 * heights)  # a logarithm ends above 0
    for place, rung in zip(places, rungs, strict=True):
        tried = [max(error, floor / 2) for _, error, _ in rung.settings]
        errors.plot(place + np.linspace(-0.2, 0.2, len(tried)), tried, ".", color=theme_of(dark)["faint"], zorder=2)
    fills = [COLOURS[0] if rung.needed else "none" for rung in rungs]
    errors.errorbar(places, heights, yerr=np.nan_to_num(spread), fmt="none", ecolor=ink, elinewidth=0.9, capsize=3, zorder=3)
    errors.scatter(
        places, heights, s=70, c=fills, edgecolors=COLOURS[0], zorder=4, label="error (filled: needed; dots: fewer to more samples)"
    )
    exact = [(place, max(rung.exact_error, floor / 2)) for place, rung in zip(places, rungs, strict=True) if np.isfinite(rung.exact_error)]
    if exact:
        errors.scatter(*zip(*exact, strict=True), marker="_", s=500, color=COLOURS[2], zorder=3, label="left by exact light up to here")
    errors.axhspan(floor * 1e-6, floor, color=theme_of(dark)["faint"], alpha=0.2, linewidth=0)
    errors.annotate("the truth's noise", (0.01, floor), xycoords=("axes fraction", "data"), va="top", fontsize=7, color=ink)
    errors.set_yscale("log")
    errors.set_ylim(min(floor / 3, 0.7 * min(heights)), 2 * max(max(heights), *(e for r in rungs for _, e, _ in r.settings)))
    errors.set(ylabel="relMSE")
    errors.set_xticks(places, [rung.mechanism.replace(" ", "\n", 1) for rung in rungs])
    times.bar(
        places, [rung.milliseconds for rung in rungs], color=[COLOURS[3] if rung.needed else theme_of(dark)["faint"] for rung in rungs]
    )
    times.set(ylabel="time per frame, ms", title=f"{found.scene.name}, {found.camera}, {found.size[0]} x {found.size[1]}")
    for ax in (times, errors):
        dress(ax, dark).grid(axis="x", visible=False)
    add_legend(figure, [errors], dark)
    return figure
