"""Pulling: Milliseconds of summing up flux, and of averaging radiosity over areas, through the tree."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import SMALL, composition, difference, indirect, milliseconds, study
from experiments.jendersie.table_2 import SETTINGS
from experiments.shared.panels import table_figure

KINDS = ("flux", "radiosity")
CELLS = tuple((name, kind) for name in SETTINGS for kind in KINDS)

PAPER_PRINTS = "pulling flux is 1 to 2.5 ms faster than pulling radiosity, on a GTX 980"


def studies() -> Sequence[ir.Study]:
    return [study("flux and radiosity", [composition(name, link__pull=kind) for name, kind in CELLS], size=SMALL, repeats=15)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per setting: milliseconds of pulling either, `ratio` radiosity / flux, and how far `apart` the pictures are."""
    rows = {}
    for name in SETTINGS:
        places = [CELLS.index((name, kind)) for kind in KINDS]
        times = [milliseconds(records, i, ("pull",)) for i in places]
        flux, radiosity = (indirect(records, i) for i in places)
        rows[name] = {**dict(zip(KINDS, times, strict=True)), "ratio": times[1] / times[0], "apart": difference(radiosity, flux)}
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    found = table(records)
    apart = ", ".join(f"{name}: {value:.1e}" for name, value in found["apart"].items())
    return table_figure(found.drop(columns="apart"), f"milliseconds of pulling (medians)\npictures apart by {apart}")
