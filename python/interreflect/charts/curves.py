"""An error against a knob or a cost: what most experiments draw."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.charts.records import axis_label, few_ticks, view_title
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure, theme_of
from interreflect.study.configurations import MERIT, NOISE_OF, VIEW, configurations
from interreflect.study.records import Records

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def curves(
    records: Records, x: str, y: str = "indirect_relmse", by: Sequence[str] = ("method",), x_label: str = "", dark: bool = False
) -> Figure:
    """`y` against `x`, a panel per view, a line per value of the columns `by`; bars: 95 % interval over seeds; below: the truth's noise.

    x: a knob or a measured column, such as "grid.resolution" or "stage.march.milliseconds"; rows without it are left out. ValueError
    where nothing is left.
    """
    table = configurations(records)
    table = table.dropna(subset=[x]) if x in table else table.head(0)
    if table.empty:
        raise ValueError(f"study {records.study!r} has no measured record with {x!r}")
    names = dict.fromkeys(_name(row, by) for _, row in table.iterrows())
    styles = {name: (COLOURS[k % len(COLOURS)], MARKERS[k % len(MARKERS)]) for k, name in enumerate(names)}
    views = list(table.groupby(VIEW, sort=False))
    figure = new_figure((4.8 * len(views), 4.0), dark)
    panels = list(figure.subplots(1, len(views), squeeze=False)[0])
    for ax, (view, rows) in zip(panels, views, strict=True):
        for name, points in rows.groupby([_name(row, by) for _, row in rows.iterrows()], sort=False):
            _line(ax, points.sort_values(x), x, y, str(name), *styles[str(name)])
        _dress(ax, rows, x, y, x in records.knob_columns, dark)
        ax.set(title=view_title(view), xlabel=x_label or axis_label(x), ylabel=axis_label(y))
        dress(ax, dark)
    add_legend(figure, panels, dark)
    return figure


def _line(ax: Axes, points: pd.DataFrame, x: str, y: str, name: str, colour: str, marker: str) -> None:
    level = points[y].to_numpy(float)
    if y in NOISE_OF:
        level = np.where(level > 0, level, points[NOISE_OF[y]] / 2)  # a logarithm has no 0
    low, high = (points.get(f"{y}_{end}", level) for end in ("low", "high"))
    reach = np.array([level - low, high - level], float)
    reach[0] = np.minimum(reach[0], 0.9 * np.abs(level))
    style: Any = {"color": colour, "marker": marker, "markersize": 4, "linewidth": 1.2, "capsize": 2, "elinewidth": 0.8}
    ax.errorbar(points[x].astype(float), level, yerr=np.nan_to_num(np.maximum(reach, 0)), label=name, **style)


def _dress(ax: Axes, rows: pd.DataFrame, x: str, y: str, knob: bool, dark: bool) -> None:
    values = sorted(rows[x].astype(float).unique())
    if min(values) > 0:
        ax.set_xscale("log")
    if y != MERIT:
        ax.set_yscale("log")
    few_ticks(ax, y != MERIT)
    if knob:
        ax.set_xticks(values, labels=[f"{value:g}" for value in values])
        ax.minorticks_off()
    if y in NOISE_OF:
        noise = float(rows[NOISE_OF[y]].max())
        ax.axhline(noise, color=theme_of(dark)["faint"], linestyle=":", linewidth=0.9, label="the truth's noise")


def _name(row: Any, by: Sequence[str]) -> str:
    """The values of some columns in words; those that the row lacks are left out."""
    words = []
    for column in by:
        value = row[column]
        if value is None or value != value:
            continue
        words.append(str(value) if isinstance(value, str) else f"{column.rpartition('.')[2]} {value:g}")
    return ", ".join(words)
