"""Break points of several atlases: measured into a folder where they resume, and drawn or told as tables."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import new_figure
from interreflect.stability.break_points import Cell
from interreflect.stability.crossing import ALWAYS, BREAKS, NEVER, REVERSED
from interreflect.stability.failure import Failure

Atlases = Mapping[str, ir.stability.Atlas]
Wanted = Mapping[str, tuple[Mapping[str, Any], Sequence[str]]]  # atlas -> methods by name, names of failures


def measured(folder: Path, wanted: Wanted, seeds: Sequence[int], sweep: int, bisections: int) -> Atlases:
    """The atlases by name; break points as `break_points.csv` and pages of pictures in `folder`."""
    kept, found = folder / "settings", {}
    for name, (methods, failures) in wanted.items():
        rows = [row for row in ir.stability.failures if row.name in failures]
        found[name] = ir.stability.atlas(methods, rows, seeds, sweep, bisections, kept)
        found[name].save(folder / f"{name}.html")
    pd.concat({name: atlas.break_points for name, atlas in found.items()}, names=["atlas"]).to_csv(folder / "break_points.csv")
    return found


LEGEND = (
    "Where each failure crosses its tolerance, from easy to hard. never: it holds all the way; always: it fails at the easy end already;\n"
    "from x: it fails at the easy end and holds from x on; *: it crosses more than once. Green: much of the way is held."
)


def chart(atlases: Atlases) -> Figure:
    """A table for each atlas: break points in the failure's unit, shaded by how far along the sweep they lie."""
    heights = [len(atlas.failures) for atlas in atlases.values()]
    widest = max(len(atlas.methods) for atlas in atlases.values())
    figure = new_figure((3.4 + 1.0 * widest, 0.4 + 1.1 * len(heights) + 0.36 * sum(heights)), dark=False)
    for axes, (name, atlas) in zip(
        figure.subplots(len(atlases), 1, squeeze=False, height_ratios=heights).ravel(), atlases.items(), strict=True
    ):
        _draw(axes, name, atlas)
    figure.supxlabel(LEGEND, fontsize=7)
    return figure


def _draw(axes: Any, name: str, atlas: ir.stability.Atlas) -> None:
    held = [[_held(atlas.cell(method, failure)) for method in atlas.methods] for failure in atlas.failures]
    axes.imshow(held, cmap="RdYlGn", vmin=-0.3, vmax=1.3, aspect="auto")
    for y, failure in enumerate(atlas.failures):
        for x, method in enumerate(atlas.methods):
            axes.text(x, y, words(atlas.cell(method, failure)), ha="center", va="center", fontsize=7)
    axes.set_xticks(range(len(atlas.methods)), atlas.methods, fontsize=7, rotation=20, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(atlas.failures)), [_label(row) for row in atlas.failures.values()], fontsize=7)
    axes.set_title(name, loc="left", fontsize=9)
    axes.tick_params(length=0)


def _held(cell: Cell) -> float:
    """Share of the sweep, from the easy end, over which a method holds; what is above at the easy end holds nothing."""
    if cell.outcome == NEVER:
        return 1.0
    return cell.failure.share(cell.crossing.value) if cell.crossing is not None and cell.outcome == BREAKS else 0.0


def words(cell: Cell) -> str:
    """A break point in few characters; "from": the other way round, it holds beyond; *: it crosses more than once."""
    if cell.crossing is None or math.isnan(cell.crossing.value):
        return {NEVER: "never", ALWAYS: "always"}.get(cell.outcome, cell.outcome)
    number = plain(cell.crossing.value) + ("*" if "crosses" in cell.crossing.words else "")
    return f"from {number}" if cell.outcome == REVERSED else number


def _label(row: Failure) -> str:
    unit = f", {row.unit}" if row.unit else ""
    return f"{row.name}{unit}\n{plain(row.easy, 6)} to {plain(row.hard, 6)}, tolerance {row.tolerance:g}"


def plain(value: float, digits: int = 3) -> str:
    """So many digits, with commas between thousands and without an exponent."""
    rounded = float(f"{value:.{digits}g}")
    return f"{rounded:,.0f}" if abs(rounded) >= 1000 else f"{rounded:g}"


def table(atlas: ir.stability.Atlas) -> pd.DataFrame:
    """Failures by methods: the break point in few characters."""
    return pd.DataFrame({method: {failure: words(atlas.cell(method, failure)) for failure in atlas.failures} for method in atlas.methods})
