"""Figure 8: How far caches are gathered: radius in tiles, time and muddiness."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import Image, caching, difference, indirect, own
from experiments.rehfeld.sites import by_site, everywhere, tables
from experiments.shared.panels import as_light, groups

RADII = (1.0, 1.5, 2.0, 3.0, 4.0)


def studies() -> Sequence[ir.Study]:
    # The radius in space grows with that on the screen, as it would end the weights otherwise.
    ways = [caching(interpolate__radius=radius, interpolate__world_radius=radius / 2) for radius in RADII]
    return [*everywhere("gathering radius, pictures", [own(16), *ways]), *everywhere("gathering radius, times", ways, repeats=3)]


def detail(image: Image) -> float:
    """Mean size of the second differences over the mean: what smoothing takes away."""
    across, down = np.abs(np.diff(image, 2, axis=1)).mean(), np.abs(np.diff(image, 2, axis=0)).mean()
    return float((across + down) / image.mean())


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per site and radius: milliseconds of the evaluation, caches read a pixel, difference from a cache a pixel, and detail."""
    return tables(_table, records)


def _table(pictures: ir.Records, times: ir.Records) -> pd.DataFrame:
    exact, rows = indirect(pictures, 0), {}
    for i, radius in enumerate(RADII):
        row = times[i].row()
        seen = float(row["stage.interpolate.covered_pixels"])
        rows[radius] = {
            "milliseconds": float(row["stage.interpolate.milliseconds"]),
            "read": float(row["stage.interpolate.cache_evaluations"]) / seen,
            "difference": difference(indirect(pictures, 1 + i), exact),
            "detail": detail(indirect(pictures, 1 + i)),
        }
    return pd.DataFrame(rows).T


def chart(*records: ir.Records) -> Figure:
    found = table(*records)
    return groups({site: _shown(its[0], found.loc[site]) for site, its in by_site(records).items()}, columns=3)


def _shown(pictures: ir.Records, found: pd.DataFrame) -> list[tuple[str, Image]]:
    exact, shown = indirect(pictures, 0), []
    for i, radius in enumerate(RADII):
        row = found.loc[radius]
        title = f"f = {radius:g}: {row['milliseconds']:.0f} ms, {row['read']:.0f} caches a pixel, {row['difference']:.1%} off"
        shown.append((title, as_light(indirect(pictures, 1 + i), exact)))
    return [*shown, ("a cache at every pixel", as_light(exact, exact))]
