"""Density: Error of indirect light against the number of caches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import GRID, SMALL, compared, composition, difference, indirect, milliseconds, precomputed
from experiments.shared.panels import as_light, panels

TEXELS = (64, 128, 256, 512)  # the grid grows with the map


def studies() -> Sequence[ir.Study]:
    def caches(texels: int) -> ir.LightMap:
        part = texels / 128
        nx, ny, nz = (round(side * part) for side in (24, 8, 12))
        return ir.LightMap(texels=texels, grid=GRID.replace(nx=nx, ny=ny, nz=nz))

    ways = [composition("setting 2", place_caches=caches(texels)) for texels in TEXELS]
    reference = ir.Reference(noise=2e-3, max_spp=512)
    return [compared("number of caches", ways, size=SMALL, reference=reference, repeats=3)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per side of the map: number of `caches`, `off` of the indirect light, `milliseconds` of cache lighting."""
    truth = np.asarray(records.truth(records[0])[1])
    rows = {}
    for i, texels in enumerate(TEXELS):
        rows[texels] = {
            "caches": precomputed(records, i)["caches"],
            "off": difference(indirect(records, i), truth),
            "milliseconds": milliseconds(records, i, ("light_caches",)),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    truth = np.asarray(records.truth(records[0])[1])
    shown = [
        (f"{row['caches']:,.0f} caches: {row['off']:.1%} off, {row['milliseconds']:.1f} ms", as_light(indirect(records, i), truth))
        for i, (_, row) in enumerate(table(records).iterrows())
    ]
    return panels([*shown, ("path-traced truth, one bounce", as_light(truth, truth))])
