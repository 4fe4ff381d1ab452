"""The chart of a sensitivity: the effect of every knob on error and on time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from interreflect.charts.style import COLOURS, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.study.sensitivity import Sensitivity


def effects(found: Sensitivity, dark: bool = False) -> Figure:
    """Bars of mu* with intervals, knobs of most effect on error first; faint where a knob does not matter for that quantity."""
    table = found.indices.sort_values("error_effect", ascending=False)
    places, ink = np.arange(len(table)), theme_of(dark)["ink"]
    figure = new_figure((9.0, 1.2 + 0.27 * len(table)), dark)
    for ax, quantity, colour in zip(figure.subplots(1, 2, sharey=True), ("error", "time"), (COLOURS[0], COLOURS[3]), strict=True):
        alphas = [1.0 if quantity in matters else 0.3 for matters in table["matters"]]
        for place, effect, alpha in zip(places, table[f"{quantity}_effect"], alphas, strict=True):
            ax.barh(place, effect, color=colour, alpha=alpha, height=0.65)
        spread = table[f"{quantity}_conf"].to_numpy(float)
        ax.errorbar(table[f"{quantity}_effect"], places, xerr=np.nan_to_num(spread), fmt="none", ecolor=ink, elinewidth=0.8, capsize=2)
        ax.set_yticks(places, table["knob"])
        ax.set(xlabel=f"effect on {quantity}, decades over the knob's range")
        ax.tick_params(labelleft=quantity == "error")
        dress(ax, dark).grid(axis="y", visible=False)
    figure.axes[0].invert_yaxis()
    figure.suptitle(f"{found.method.name}: {found.scene.name}, {found.camera} (faint: does not matter)", fontsize=10, color=ink)
    return figure
