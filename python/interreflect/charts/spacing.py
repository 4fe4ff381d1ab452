"""The chart of how evenly surfels lie."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from interreflect.charts.style import COLOURS, add_legend, dress, new_figure, theme_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from interreflect.spacing import SurfelSpacing


def histogram(spacing: SurfelSpacing, dark: bool = False) -> Figure:
    """Bars of the surfels' distances to their nearest neighbours; a curve by chance; lines for blue noise and the densest packing."""
    from interreflect.spacing import BLUE, HEXAGONAL, by_chance

    borders, density = spacing.histogram()
    figure = new_figure((6.4, 3.6), dark)
    axes = figure.subplots()
    axes.stairs(density, borders, fill=True, color=COLOURS[0], alpha=0.7, label="surfels")
    places = np.linspace(0, borders[-1], 200)
    axes.plot(places, by_chance(places), color=theme_of(dark)["ink"], linewidth=1.2, label="by chance")
    axes.axvline(BLUE, color=COLOURS[1], linestyle="--", label="blue noise: none nearer")
    axes.axvline(HEXAGONAL, color=COLOURS[2], linestyle=":", label="densest packing: all")
    axes.set_xlabel("distance to the nearest neighbour / root of the area")
    axes.set_ylabel("density")
    dress(axes, dark)
    add_legend(figure, [axes], dark, columns=2)
    return figure
