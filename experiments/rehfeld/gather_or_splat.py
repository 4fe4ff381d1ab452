"""3.3: Gathering and splatting: the same weights, two ways to find the caches of a pixel."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching, difference, indirect, own
from experiments.rehfeld.sites import CARS, study
from experiments.shared.panels import as_light, panels

WAYS = {
    "gather": ir.Gather(),
    "splat, minimum": ir.Splat(weight="minimum"),
    "splat, world": ir.Splat(weight="world"),
}


def studies() -> Sequence[ir.Study]:
    ways = [caching(interpolate=way) for way in WAYS.values()]
    return [study(CARS, "gather or splat, pictures", [own(16), *ways]), study(CARS, "gather or splat, times", ways, repeats=3)]


def table(pictures: ir.Records, times: ir.Records) -> pd.DataFrame:
    """A row per way: milliseconds of the evaluation, caches read, and the picture's difference from a cache a pixel."""
    exact, rows = indirect(pictures, 0), {}
    for i, name in enumerate(WAYS):
        row = times[i].row()
        rows[name] = {
            "milliseconds": float(row["stage.interpolate.milliseconds"]),
            "evaluations": float(row["stage.interpolate.cache_evaluations"]),
            "difference": difference(indirect(pictures, 1 + i), exact),
        }
    return pd.DataFrame(rows).T


def chart(pictures: ir.Records, times: ir.Records) -> Figure:
    exact, found = indirect(pictures, 0), table(pictures, times)
    shown = []
    for i, name in enumerate(WAYS):
        row = found.loc[name]
        title = f"{name}: {row['milliseconds']:.0f} ms, {row['evaluations'] / 1e6:.1f} M caches read, {row['difference']:.1%} off"
        shown.append((title, as_light(indirect(pictures, 1 + i), exact)))
    return panels([*shown, ("a cache at every pixel", as_light(exact, exact))])
