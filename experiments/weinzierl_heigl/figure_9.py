"""Figure 9: Frame time against the number of lights, by simple lookups and by PCSS."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.weinzierl_heigl.pipeline import FULL, area_lights, study
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

COUNTS = (16, 32, 64, 128, 256, 512, 1024)
LOOKUPS = {"simple": ir.SimpleLookup(), "PCSS": ir.Pcss()}


def studies() -> Sequence[ir.Study]:
    ways = [area_lights(sample_lights__lights=count, filter_shadows=lookup) for lookup in LOOKUPS.values() for count in COUNTS]
    return [study("number of lights", ways, size=FULL, repeats=5, images=False)]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds of a frame: a row per number of lights, a column per lookup."""
    times = [record.milliseconds for record in records]
    return pd.DataFrame({name: times[i * len(COUNTS) : (i + 1) * len(COUNTS)] for i, name in enumerate(LOOKUPS)}, index=list(COUNTS))


def chart(records: ir.Records) -> Figure:
    times = table(records)
    figure = new_figure((5.0, 3.4), dark=False)
    axes = figure.subplots()
    for name, colour, marker in zip(times, COLOURS, MARKERS, strict=False):
        axes.plot(times.index, times[name], color=colour, marker=marker, label=name)
    axes.set_xscale("log", base=2)
    axes.set_xticks(COUNTS, [str(count) for count in COUNTS])
    axes.set(xlabel="virtual area lights", ylabel="frame, milliseconds", ylim=(0, None))
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
