"""Charts of the atlas: break points along each sweep, and leaks against over-occlusion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.stability.break_points import Atlas, Cell

LEAKS, OCCLUSIONS = "leak through", "occlusion by"


def break_points(atlas: Atlas, dark: bool = False) -> Figure:
    """A line per failure from its easy end (left) to its hard end; a mark where each method's error crosses the tolerance, with interval.

    Marks at the right margin never cross, at the left margin are always above; a hollow mark is above before it and below after it.
    """
    rows = [name for name in atlas.failures if any(cell.crossing is not None for cell in atlas.cells if cell.failure.name == name)]
    figure = new_figure((8.5, 1.0 + 0.34 * len(rows)), dark)
    axes = figure.subplots()
    styles = {name: (COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]) for k, name in enumerate(atlas.methods)}
    for y, name in enumerate(rows):
        for k, method in enumerate(atlas.methods):
            cell = atlas.cell(method, name)
            if cell.crossing is not None:
                _mark(axes, cell, y + 0.6 * ((k + 0.5) / len(atlas.methods) - 0.5), *styles[method])
    for method, (colour, marker) in styles.items():
        axes.plot([], [], color=colour, marker=marker, linestyle="", label=method)
    axes.set_yticks(range(len(rows)), rows)
    axes.invert_yaxis()
    axes.set_xlim(-0.13, 1.13)
    axes.set_xticks([-0.08, 0, 0.5, 1, 1.08], ["always\nabove", "easy", "", "hard", "never"])
    axes.set_xlabel("break point along the sweep of the knob")
    dress(axes, dark)
    add_legend(figure, [axes], dark, columns=3)
    return figure


def _mark(axes: Any, cell: Cell, y: float, colour: str, marker: str) -> None:
    crossing, row = cell.crossing, cell.failure
    assert crossing is not None
    if crossing.before is None:
        axes.plot(1.08 if crossing.outcome == "never" else -0.08, y, color=colour, marker=marker, markersize=4)
        return
    axes.plot([row.share(crossing.low), row.share(crossing.high)], [y, y], color=colour, linewidth=1.4)
    face = "none" if crossing.outcome == "reversed" else colour
    axes.plot(row.share(crossing.value), y, color=colour, marker=marker, markersize=5, markerfacecolor=face)


def leak_against_occlusion(atlas: Atlas, dark: bool = False) -> Figure:
    """Mean leak over the sweeps through walls against the mean signed occlusion error over the sweeps below blockers.

    The values of the first pass are the same for every method. ValueError without cells of both kinds.
    """
    figure = new_figure((6.0, 4.4), dark)
    axes = figure.subplots()
    shown = 0
    for k, method in enumerate(atlas.methods):
        leaks, hidden = [_means(atlas, method, prefix) for prefix in (LEAKS, OCCLUSIONS)]
        if not leaks or not hidden:
            continue
        shown += 1
        axes.scatter(np.mean(leaks), np.mean(hidden), s=50, color=COLOURS[k % len(COLOURS)], marker=MARKERS[k % len(MARKERS)], label=method)
    if not shown:
        raise ValueError("the atlas has no method with both a leak and an occlusion")
    axes.axhline(0, color=theme_of(dark)["faint"], linewidth=0.8)
    axes.set_xscale("symlog", linthresh=1e-3)
    axes.set_xlim(-2e-4, 2 * axes.get_xlim()[1])
    axes.set(xlabel="light leaked through walls, mean over the sweeps", ylabel="sky hidden too much (+) or too little (-), mean")
    dress(axes, dark)
    add_legend(figure, [axes], dark, columns=2)
    return figure


def _means(atlas: Atlas, method: str, prefix: str) -> list[float]:
    means = []
    for cell in atlas.cells:
        if cell.method == method and cell.failure.name.startswith(prefix) and cell.crossing is not None:
            means.append(float(np.mean([p.error if np.isnan(p.signed) else p.signed for p in cell.crossing.swept])))
    return means
