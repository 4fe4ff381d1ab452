"""Charts of a study's records."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect import metrics
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure, theme_of
from interreflect.study.configurations import MERIT, NOISE_OF, VIEW, WORK, configurations
from interreflect.study.pareto import pareto
from interreflect.study.records import OK, Record, Records

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LABELS = {
    "milliseconds": "time per frame, ms (median)",
    "milliseconds_p95": "time per frame, ms (95th percentile)",
    "precompute_milliseconds": "precomputation, ms",
    "bytes": "memory of the stages' results, bytes",
    "peak_memory_bytes": "peak memory of the process, bytes",
    "relmse": "relMSE",
    "trimmed_relmse": "relMSE without the largest .1 %",
    "indirect_relmse": "relMSE of indirect light",
    "indirect_trimmed_relmse": "relMSE of indirect light without the largest .1 %",
    "flip": "mean HDR-FLIP",
    "ssim": "SSIM (better upward)",
}
ERROR_RANGE = (1e-4, 1.0)  # relative squared error of a pixel, black to white in error maps
NAMED_POINTS = 10  # points of a front that get their knobs written beside them,
NAME_LENGTH = 44  # a line of so many characters


def speed_accuracy(records: Records, x: str = "milliseconds", y: str = "relmse", dark: bool = False) -> Figure:
    """Error against time, log-log, a panel per scene, camera and bounces; a point per configuration, seeds averaged.

    Lines join what no other setting of the same method beats; ringed points are beaten by no method. Errors in the shaded
    band are within the truth's own noise. ValueError for columns that do not rank, or if nothing was measured.
    """
    table, front = (_above_zero(rows, y) for rows in (configurations(records), pareto(records, x, y)))
    table = table[(table[x] > 0) & np.isfinite(table[y]) & ((table[y] > 0) | (y == MERIT))]
    _need(table, f"a positive {x} and {y}")
    views = list(table.groupby(VIEW, sort=False))
    figure, axes = _panels(len(views), dark)
    styles = _styles(table["method"])
    for ax, (view, rows) in zip(axes, views, strict=True):
        for method, points in rows.groupby("method", sort=False):
            colour, marker = styles[str(method)]
            ax.scatter(points[x], points[y], s=26, color=colour, marker=marker, label=str(method), zorder=3)
            own = _own_front(points, x, y)
            ax.plot(own[x], own[y], color=colour, linewidth=1, alpha=0.7, zorder=2)
        ax.set_xscale("log")
        ax.set_yscale("linear" if y == MERIT else "log")
        ax.margins(0.12)
        best = front[(front[VIEW] == list(view)).all(axis=1) & (front[x] > 0) & ((front[y] > 0) | (y == MERIT))]
        ax.scatter(best[x], best[y], s=110, facecolors="none", edgecolors=theme_of(dark)["ink"], linewidths=0.8, zorder=4)
        for method, points in rows.groupby("method", sort=False):
            _draw_intervals(ax, points, x, y, styles[str(method)][0])
        _name_points(ax, best.head(NAMED_POINTS), x, y, varied(records), dark)
        _noise_band(ax, rows, y, dark)
        few_ticks(ax, y != MERIT)
        ax.set_title(view_title(view), fontsize=9)
        ax.set(xlabel=axis_label(x), ylabel=axis_label(y))
    add_legend(figure, axes, dark)
    return figure


def stages(records: Records, dark: bool = False) -> Figure:
    """Where the time of a frame goes: a stacked bar per configuration, a panel per view and method with its own scale.

    "other" is the frame's time outside its stages. ValueError if nothing was measured.
    """
    table = configurations(records)
    _need(table, "stages")
    columns = [name for name in table.columns if name.startswith("stage.") and name.endswith(".milliseconds")]
    table["stage.other.milliseconds"] = (table["milliseconds"] - table[columns].sum(axis=1)).clip(lower=0)
    columns.append("stage.other.milliseconds")
    groups = list(table.groupby([*VIEW, "method"], sort=False))
    figure, axes = _rows([len(rows) for _, rows in groups], dark)
    told_apart = varied(records)
    for ax, (group, rows) in zip(axes, groups, strict=True):
        left, places = np.zeros(len(rows)), np.arange(len(rows))
        for index, column in enumerate(columns):
            width = rows[column].fillna(0).to_numpy(float)
            colour = theme_of(dark)["faint"] if column == columns[-1] else COLOURS[index % len(COLOURS)]
            hatch = "////" if index >= len(COLOURS) and column != columns[-1] else None
            label = column.removeprefix("stage.").removesuffix(".milliseconds")
            ax.barh(places, width, left=left, color=colour, hatch=hatch, label=label if width.any() else None, height=0.7)
            left += width
        ax.set_yticks(places, [_knobs(row, told_apart) or str(group[-1]) for _, row in rows.iterrows()])
        ax.invert_yaxis()
        ax.set_title(f"{group[-1]}: {view_title(group[:-1])}", fontsize=9)
        ax.set(xlabel=LABELS["milliseconds"])
        ax.grid(axis="y", visible=False)
    add_legend(figure, axes, dark)
    return figure


def images(records: Records, limit: int = 6, dark: bool = False) -> Figure:
    """Pictures beside their truth with error maps below, a pair of rows per view; the first seed of each.

    Shown are every method's most accurate configuration and those on the front, at most `limit` a view. Tone-mapped with the
    truth's exposure (`metrics.tone_map`); error maps share one logarithmic scale. ValueError if no pictures were kept.
    """
    shown = [(view, picked) for view, picked in pictured(records, limit) if picked]
    if not shown:
        raise ValueError(f"study {records.study!r} has no pictures to show")
    columns = 1 + max(len(picked) for _, picked in shown)
    figure = new_figure((2.6 * columns, 4.0 * len(shown)), dark)
    grid = figure.subplots(2 * len(shown), columns, squeeze=False)
    mapped = None
    for row, (view, picked) in enumerate(shown):
        upper, lower = grid[2 * row], grid[2 * row + 1]
        truth = records.truth(picked[0])[0]
        upper[0].imshow(metrics.tone_map(truth, truth))
        upper[0].set_title(textwrap.fill(f"{view_title(view)}: truth, relMSE {picked[0].noise:.1e}", 40), fontsize=8)
        for ax, below, record in zip(upper[1:], lower[1:], picked, strict=False):
            image = records.images(record)[0]
            ax.imshow(metrics.tone_map(image, truth))
            name = textwrap.fill(textwrap.shorten(label(records, record.row()), 2 * NAME_LENGTH, placeholder=" …"), NAME_LENGTH)
            ax.set_title(f"{name}\n{record.milliseconds:,.{1 if record.milliseconds < 100 else 0}f} ms", fontsize=8)
            mapped = below.imshow(metrics.error_map(image, truth), cmap="magma", norm=_error_norm())
            below.set_title(f"relMSE {record.metrics['relmse']:.2e}", fontsize=8)
    for ax in grid.flat:
        ax.set_axis_off()
        ax.title.set_color(theme_of(dark)["ink"])
    if mapped is not None:
        bar = figure.colorbar(mapped, ax=list(grid.flat), shrink=0.5, extend="both", location="bottom", fraction=0.04, pad=0.02)
        bar.set_label("relative squared error of a pixel", color=theme_of(dark)["ink"], fontsize=8)
        bar.ax.tick_params(which="both", colors=theme_of(dark)["ink"], labelsize=8)
    return figure


def pictured(records: Records, limit: int) -> list[tuple[tuple[Any, ...], list[Record]]]:
    """Per view, the records whose pictures are worth showing, fast to slow: every method's most accurate, then those on the front."""
    first: dict[tuple[Any, ...], Record] = {}
    for record in records:
        if record.status == OK and records.has_images(record):
            first.setdefault((record.scene, record.camera, record.row()["bounces"], record.configuration), record)
    table, front, result = configurations(records), pareto(records), []
    for view, rows in table.groupby(VIEW, sort=False):
        most_accurate = rows.loc[rows.groupby("method", sort=False)["relmse"].idxmin()]["configuration"]
        on_front = front[(front[VIEW] == list(view)).all(axis=1)]["configuration"]
        wanted = list(dict.fromkeys([*most_accurate, *on_front]))[:limit]
        picked = [first[(*view, configuration)] for configuration in wanted if (*view, configuration) in first]
        result.append((tuple(view), sorted(picked, key=lambda record: record.milliseconds)))
    return result


def axis_label(column: str) -> str:
    """A measured column as an axis names it, with its unit."""
    return LABELS.get(column) or f"{column.removeprefix(WORK).replace('_', ' ')} a frame, count"


def _error_norm() -> Any:
    from matplotlib.colors import LogNorm

    return LogNorm(*ERROR_RANGE, clip=True)


def _panels(count: int, dark: bool) -> tuple[Figure, list[Axes]]:
    columns = min(count, 2)
    rows = math.ceil(count / columns)
    figure = new_figure((6.4 * columns, 4.6 * rows), dark)
    axes = list(figure.subplots(rows, columns, squeeze=False).flat)
    for unused in axes[count:]:
        unused.remove()
    return figure, [dress(ax, dark) for ax in axes[:count]]


def _rows(bars: Sequence[int], dark: bool) -> tuple[Figure, list[Axes]]:
    figure = new_figure((8.5, 0.6 + sum(0.95 + 0.3 * n for n in bars)), dark)
    axes = figure.subplots(len(bars), 1, squeeze=False, gridspec_kw={"height_ratios": [0.95 + 0.3 * n for n in bars]})
    return figure, [dress(ax, dark) for ax in axes.flat]


def _styles(methods: pd.Series[Any]) -> dict[str, tuple[str, str]]:
    names = [str(name) for name in methods.unique()]
    return {name: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, name in enumerate(names)}


def _above_zero(rows: pd.DataFrame, y: str) -> pd.DataFrame:
    """Errors that vanish when the truth's noise is subtracted are drawn at half that noise: a logarithm has no 0."""
    return rows.assign(**{y: rows[y].where(rows[y] > 0, rows[NOISE_OF[y]] / 2)}) if y in NOISE_OF else rows


def _draw_intervals(ax: Axes, points: pd.DataFrame, x: str, y: str, colour: str) -> None:
    """Thin lines along both axes where the intervals are known."""
    for column, name in ((x, "xerr"), (y, "yerr")):
        if f"{column}_low" in points:
            reach = np.array([points[column] - points[f"{column}_low"], points[f"{column}_high"] - points[column]], float)
            reach[0] = np.minimum(reach[0], 0.9 * points[column].abs())  # a logarithm ends above 0
            spread: Any = {name: np.nan_to_num(np.maximum(reach, 0))}
            ax.errorbar(points[x], points[y], fmt="none", ecolor=colour, elinewidth=0.7, alpha=0.6, zorder=2, **spread)


def _own_front(points: pd.DataFrame, x: str, y: str) -> pd.DataFrame:
    ordered = points.sort_values([x, y], ascending=[True, y != MERIT])
    best = ordered[y].cummax() if y == MERIT else ordered[y].cummin()
    return ordered[(ordered[y] == best) & ~best.duplicated()]


def _noise_band(ax: Axes, rows: pd.DataFrame, y: str, dark: bool) -> None:
    if y not in NOISE_OF or not (rows[NOISE_OF[y]] > 0).any():
        return
    noise, theme = float(rows[NOISE_OF[y]].max()), theme_of(dark)
    ax.axhspan(noise * 1e-9, noise, color=theme["faint"], alpha=0.2, linewidth=0, zorder=1)
    ax.annotate("the truth's noise", (0.01, noise), xycoords=("axes fraction", "data"), va="top", fontsize=7, color=theme["faint"])
    lowest = min(float(rows[y].min()), noise)
    ax.set_ylim(lowest / 2, float(rows[y].max()) * 2)


def few_ticks(ax: Axes, also_y: bool) -> None:
    """Plain numbers at 1, 2 and 5 where an axis spans less than two decades; powers of ten where it spans more."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for axis, (low, high) in ((ax.xaxis, ax.get_xlim()), (ax.yaxis, ax.get_ylim())):
        if axis is ax.yaxis and not also_y:
            continue
        axis.set_minor_formatter(NullFormatter())
        if high < 100 * low:
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def varied(records: Records) -> dict[str, list[str]]:
    """Method -> the knob columns that differ between its measured records: those that tell its points apart."""
    measured = records.table[records.table["status"] == OK]
    names = records.knob_columns
    spread = {method: rows[names].nunique() for method, rows in measured.groupby("method")}
    return {str(method): [name for name in names if counts[name] > 1] for method, counts in spread.items()}


def label(records: Records, row: Any) -> str:
    """The method of a row of the table, with the knobs that tell it from its siblings."""
    return f"{row['method']} {_knobs(row, varied(records))}".strip()


def _knobs(row: Any, names: Mapping[str, Sequence[str]]) -> str:
    """The knobs in words; those that this row's technique does not have are left out."""
    values = [(name, row.get(name)) for name in names.get(row["method"], ())]
    return ", ".join(_short(name, value) for name, value in values if value is not None and value == value)


def _short(name: str, value: Any) -> str:
    text = f"{value:g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value).removesuffix("()")
    return text if isinstance(value, str) else f"{name.rpartition('.')[2]} {text}"


def _name_points(ax: Axes, rows: pd.DataFrame, x: str, y: str, told_apart: Mapping[str, Sequence[str]], dark: bool) -> None:
    low, high = ax.get_xlim()
    ax.set_xlim(low, high * (high / low) ** 0.25)  # room for the last one's words
    for _, row in rows.iterrows():
        text = textwrap.shorten(_knobs(row, told_apart), NAME_LENGTH, placeholder=" …")
        note = ax.annotate(text, (row[x], row[y]), xytext=(7, 5), textcoords="offset points", fontsize=6.5, color=theme_of(dark)["ink"])
        note.set_in_layout(False)  # words may cross the panel's edge; they must not squeeze it


def view_title(view: Any) -> str:
    scene, camera, bounces = view
    return f"{scene}, {camera}, {'all bounces' if bounces == 'all' else f'bounces={bounces}'}"


def _need(table: pd.DataFrame, what: str) -> None:
    if table.empty:
        raise ValueError(f"no record has {what}")
