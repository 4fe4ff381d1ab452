"""The charts of a page that filter and answer the pointer: speed against accuracy and stages, drawn by Plotly from records."""

from __future__ import annotations

import base64
import gzip
import math
from html import escape
from typing import TYPE_CHECKING, Any

from interreflect import charts
from interreflect.charts.records import axis_label
from interreflect.charts.style import COLOURS
from interreflect.study.configurations import COSTS, ERRORS, MERIT, NOISE_OF, VIEW, WORK, configurations
from interreflect.study.page import asset
from interreflect.study.page.parts import script_data
from interreflect.study.pareto import pareto
from interreflect.study.records import Records

if TYPE_CHECKING:
    import pandas as pd

SYMBOLS = ("circle", "square", "diamond", "triangle-down", "triangle-up", "cross", "x", "star")
MEASURED = ("milliseconds", "bytes")  # of a stage, beside its work counts
OTHER = "other"  # the frame's time outside its stages


def plotly_source() -> str:
    """Plotly's script, packed. ImportError names the extra that brings it."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise ImportError("a report needs Plotly, which comes with the extra `view`: pip install interreflect[view]") from error
    packed = gzip.compress(get_plotlyjs().encode(), mtime=0)
    return f'<script type="text/plain" id="plotly">{base64.b64encode(packed).decode()}</script>'


def interactive(records: Records) -> str:
    """Filters, then a chart of speed against accuracy per view, then the bars of its stages; for records with a measured cell."""
    table, data = configurations(records), page_data(records)
    titles = [escape(view["title"]) for view in data["views"]]
    speed, bars = (
        "".join(f'<div class="chart"><h4>{title}</h4><div id="{kind}-{k}"></div></div>' for k, title in enumerate(titles))
        for kind in ("speed", "stages")
    )
    return (
        f'<form id="filters">{_controls(data, table)}<h3>Speed against accuracy</h3><div class="charts">{speed}</div>'
        f'<h3>Where the time goes</h3><p class="controls"><label>bars <select name="bars"><option value="share">share of the frame</option>'
        f'<option value="milliseconds">milliseconds</option></select></label></p>{_legend(data)}<div class="charts">{bars}</div></form>'
        f'{script_data("data", data)}{plotly_source()}<script type="module">\n{asset("charts.js")}</script>'
    )  # fmt: skip


def page_data(records: Records) -> dict[str, Any]:
    """What the charts draw: a point per configuration, numbered as the rows of `configurations`."""
    table = configurations(records)
    names = stage_names(table)
    methods = [str(name) for name in table["method"].unique()]
    notes = {tuple(row[name] for name in (*VIEW, "configuration")): row["note"] for _, row in pareto(records).iterrows()}
    views = []
    for view, rows in table.groupby(VIEW, sort=False):
        points = [_point(records, row, index, names, notes) for index, (_, row) in zip(rows.index.tolist(), rows.iterrows(), strict=True)]
        noise = {name: _number(rows[name].max()) or 0.0 for name in set(NOISE_OF.values())}
        views.append({"title": charts.view_title(view), "points": points, "noise": noise})
    return {
        "views": views,
        "filters": filters(records, methods),
        "styles": {name: {"colour": COLOURS[k % len(COLOURS)], "symbol": SYMBOLS[k % len(SYMBOLS)]} for k, name in enumerate(methods)},
        "stages": [*names, OTHER],
        "stageStyles": [_bar_style(k, name == OTHER) for k, name in enumerate([*names, OTHER])],
        "labels": {name: axis_label(name) for name in (*COSTS, *ERRORS, MERIT, *work_names(table))},
        "noiseOf": NOISE_OF,
        "merit": MERIT,
    }


def filters(records: Records, methods: list[str]) -> list[dict[str, Any]]:
    """The method, and every knob that differs between measured records of a method, with their values as words."""
    knobs = dict.fromkeys(name for names in charts.varied(records).values() for name in names)
    table = configurations(records)
    choices = [{"name": "method", "values": methods}] if len(methods) > 1 else []
    for name in knobs:
        choices.append({"name": name, "values": list(dict.fromkeys(_word(value) for value in _sorted(table[name].dropna())))})
    return choices


def stage_names(table: pd.DataFrame) -> list[str]:
    return [name[6:-13] for name in table.columns if name.startswith("stage.") and name.endswith(".milliseconds")]


def work_names(table: pd.DataFrame) -> list[str]:
    return [name for name in table.columns if name.startswith(WORK)]


def _point(records: Records, row: pd.Series[Any], index: int, names: list[str], notes: dict[Any, str]) -> dict[str, Any]:
    knobs = {name: _word(row[name]) for name in records.knob_columns if name in row.index and not _absent(row[name])}
    columns = [name for name in row.index if name in (*COSTS, *ERRORS, MERIT) or name.startswith(WORK)]
    ends = {name: [_number(row[f"{name}_low"]), _number(row[f"{name}_high"])] for name in columns if f"{name}_low" in row.index}
    return {
        "id": index,
        "method": row["method"],
        "shown": escape(charts.label(records, row)),
        "knobs": knobs,
        "values": {name: _number(row[name]) for name in columns},
        "intervals": {name: pair for name, pair in ends.items() if None not in pair},
        "note": notes.get(tuple(row[name] for name in (*VIEW, "configuration")), ""),
        "stages": _stages(row, names),
    }


def _stages(row: pd.Series[Any], names: list[str]) -> list[dict[str, Any]]:
    found, spent = [], 0.0
    for name in names:
        milliseconds = _number(row[f"stage.{name}.milliseconds"])
        if milliseconds is None:
            continue
        spent += milliseconds
        work = [f"{row[f'stage.{name}.bytes'] / 2**20:.1f} MiB"]
        counted = [column for column in row.index if column.startswith(f"stage.{name}.") and column.rpartition(".")[2] not in MEASURED]
        work += [f"{row[column]:,.0f} {column.rpartition('.')[2].replace('_', ' ')}" for column in counted if _number(row[column])]
        found.append({"name": name, "milliseconds": milliseconds, "work": work})
    return [*found, {"name": OTHER, "milliseconds": max(0.0, float(row["milliseconds"]) - spent), "work": []}] if found else []


def _controls(data: dict[str, Any], table: pd.DataFrame) -> str:
    parts = []
    costs, errors = (*COSTS, *work_names(table)), (*ERRORS, MERIT)
    for name, side, columns in (("x", "horizontal", costs), ("y", "vertical", errors)):
        measured = [column for column in columns if (table[column].astype(float) > 0).any()]
        parts.append(_select(name, side, [(column, axis_label(column)) for column in measured]))
    for k, one in enumerate(data["filters"]):
        parts.append(_select(f"filter-{k}", one["name"], [("", "any"), *((value, value) for value in one["values"])]))
    for name in ("front", "intervals"):
        parts.append(f'<label><input type="checkbox" name="{name}" checked> {name}</label>')
    parts.append('<button type="reset">reset</button> <span id="kept" role="status"></span>')
    words = "A filter on a knob leaves methods without that knob. Rings: beaten by no other shown; lines: the same within a method."
    return f'<div class="controls">{"".join(parts)}</div><p class="words">{words}</p>'


def _legend(data: dict[str, Any]) -> str:
    entries = []
    for name, style in zip(data["stages"], data["stageStyles"], strict=True):
        colour = style["color"]
        paper = f"repeating-linear-gradient(135deg, {colour} 0 2px, transparent 2px 5px)" if "pattern" in style else colour
        entries.append(f'<li><i style="background: {paper}"></i>{escape(name)}</li>')
    return f'<ul class="legend">{"".join(entries)}</ul>'


def _select(name: str, label: str, options: list[tuple[str, str]]) -> str:
    listed = "".join(f'<option value="{escape(value)}">{escape(text)}</option>' for value, text in options)
    return f'<label>{escape(label)} <select name="{name}">{listed}</select></label>'


def _bar_style(index: int, other: bool) -> dict[str, Any]:
    if other:
        return {"color": "rgba(128, 128, 128, 0.3)"}
    hatched = {"pattern": {"shape": "/", "size": 6, "solidity": 0.3}} if index >= len(COLOURS) else {}
    return {"color": COLOURS[index % len(COLOURS)], **hatched}


def _sorted(values: pd.Series[Any]) -> list[Any]:
    return sorted(values.unique(), key=lambda value: (isinstance(value, str), str(value)) if isinstance(value, str) else (False, value))


def _word(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)


def _absent(value: Any) -> bool:
    return value is None or (isinstance(value, float) and math.isnan(value))


def _number(value: Any) -> float | None:
    return float(value) if value is not None and math.isfinite(value) else None
