"""Figure 5.2: The times of table 5.1 as stacked bars."""

from __future__ import annotations

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed import table_5_1
from experiments.freed.table_5_1 import studies as studies
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure


def chart(*records: ir.Records) -> Figure:
    times = table_5_1.table(*records)
    figure = new_figure((8.0, 3.8), dark=False)
    axes = figure.subplots()
    names = [f"{grid}\n{size}" if grid == "128^3" else grid for size, grid in times.columns]
    base = 0.0 * times.loc["total"].to_numpy(float)
    parts = times.drop(index="total")
    for (name, row), colour in zip(parts.iterrows(), COLOURS, strict=False):
        axes.bar(range(len(names)), row, bottom=base, color=colour, label=str(name))
        base = base + row.to_numpy(float)
    rest = (times.loc["total"].to_numpy(float) - base).clip(0)
    axes.bar(range(len(names)), rest, bottom=base, color="#999999", label="other")
    axes.set_xticks(range(len(names)), names)
    axes.set(xlabel="resolution of the grid, size of the picture", ylabel="milliseconds a frame")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
