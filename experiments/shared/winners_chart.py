"""Who wins, drawn: a cell per scene, light, kind and budget, coloured by the method that is first."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from experiments.shared.winners import WITHIN_NOISE
from interreflect.charts.style import COLOURS, new_figure

EXTRA = ("#882255", "#44AA99")  # nine methods and more need as many colours
ERRORS = ("relmse", "flip")


def who_wins(found: pd.DataFrame) -> Figure:
    """Two panels, by relMSE and by FLIP; a hollow dot where the next is within noise."""
    firsts = found[(found["place"] == 1) & found["by"].isin(ERRORS)]
    methods, scenes = sorted(firsts["method"].unique()), list(dict.fromkeys(firsts["scene"]))
    columns = list(dict.fromkeys(zip(firsts["light"], firsts["kind"], firsts["budget"], strict=True)))
    palette = [*COLOURS, *EXTRA][: len(methods)]
    figure = new_figure((4.0 + 0.62 * len(columns) * len(ERRORS), 2.2 + 0.24 * len(scenes)), dark=False)
    for axes, by in zip(figure.subplots(1, len(ERRORS), sharey=True), ERRORS, strict=True):
        cells = firsts[firsts["by"] == by].set_index(["scene", "light", "kind", "budget"])
        _draw(axes, cells, methods, scenes, columns, palette)
        axes.set_title(f"by {by}", fontsize=9)
    patches = [Patch(color=colour) for colour in palette]
    figure.legend(patches, methods, loc="outside lower center", ncols=min(5, len(methods)), frameon=False, fontsize=8)
    return figure


def _draw(
    axes: Any, cells: pd.DataFrame, methods: list[str], scenes: list[str], columns: list[tuple[Any, ...]], palette: list[str]
) -> None:
    grid = [[methods.index(cells.loc[(scene, *column), "method"]) for column in columns] for scene in scenes]
    axes.imshow(grid, cmap=ListedColormap(palette), vmin=-0.5, vmax=len(methods) - 0.5, aspect="auto")
    for y, scene in enumerate(scenes):
        for x, column in enumerate(columns):
            if cells.loc[(scene, *column), "note"] == WITHIN_NOISE:
                axes.plot([x], [y], "o", markerfacecolor="none", color="white", markersize=4)
    axes.set_xticks(range(len(columns)), [f"{kind},\n{light},\n{budget} ms" for light, kind, budget in columns], fontsize=6, rotation=90)
    axes.set_yticks(range(len(scenes)), scenes, fontsize=7)
