"""Table 3: Milliseconds of cache lighting and shading against bands of luma and of chrominance, with run-time projection."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import FULL, milliseconds, projected, study
from experiments.shared.panels import table_figure

BANDS = range(2, 9)
PAIRS = tuple((luma, chrominance) for luma in BANDS for chrominance in BANDS if chrominance <= luma)
STAGES = ("light_caches", "evaluate")  # the paper's shading holds direct light as well
NAN = float("nan")
# Milliseconds on a GTX 980; rows: chrominance, columns: luma, both from 2 to 8.
PAPER = np.array(
    [
        [2.48, 2.69, 2.95, 3.59, 3.78, 4.50, 5.35],
        [NAN, 3.21, 3.41, 4.01, 4.07, 5.22, 5.83],
        [NAN, NAN, 3.33, 4.14, 4.39, 5.35, 6.31],
        [NAN, NAN, NAN, 4.69, 5.67, 6.26, 6.78],
        [NAN, NAN, NAN, NAN, 5.95, 6.94, 7.80],
        [NAN, NAN, NAN, NAN, NAN, 7.61, 11.89],
        [NAN, NAN, NAN, NAN, NAN, NAN, 10.35],
    ]
)

PAPER_PRINTS = "in the table's lower half: milliseconds on a GTX 980, with direct light"


def studies() -> Sequence[ir.Study]:
    """As many bands of both are red, green and blue: no compression."""
    return [study("bands of luma and chrominance", [way(*pair) for pair in PAIRS], size=FULL, repeats=3, images=False)]


def way(luma: int, chrominance: int) -> ir.methods.IlluminanceComposition:
    return projected(link__bands=luma, evaluate__chrominance_bands=0 if chrominance == luma else chrominance)


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per number of bands of chrominance, a column per number of bands of luma."""
    times = pd.DataFrame(NAN, index=list(BANDS), columns=list(BANDS))
    for i, (luma, chrominance) in enumerate(PAIRS):
        times.loc[chrominance, luma] = milliseconds(records, i, STAGES)
    return times


def chart(records: ir.Records) -> Figure:
    times = table(records)
    shown = pd.concat({"ours": times, "GTX 980": pd.DataFrame(PAPER, times.index, times.columns)})
    named = shown.set_axis([f"{machine}, {bands} of chrominance" for machine, bands in shown.index])
    return table_figure(named.rename(columns=lambda bands: f"{bands} bands"), "milliseconds of cache lighting and evaluation (medians)")
