"""Figure 5.6: The times of table 5.2 as a graph."""

from __future__ import annotations

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed import table_5_2
from experiments.freed.table_5_2 import studies as studies
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure


def chart(records: ir.Records) -> Figure:
    times = table_5_2.table(records)
    figure = new_figure((5.0, 3.4), dark=False)
    axes = figure.subplots()
    for name, colour, marker in zip(times.columns, COLOURS, MARKERS, strict=False):
        axes.plot(times.index, times[name], color=colour, marker=marker, label=str(name))
    axes.set_xscale("log", base=2)
    axes.set_xticks(list(times.index), [f"{n}^3" for n in times.index])
    axes.set_ylim(bottom=0)
    axes.set(xlabel="resolution of the grid", ylabel="milliseconds to voxelize (median)")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
