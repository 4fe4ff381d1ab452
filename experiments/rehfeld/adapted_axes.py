"""3.2: Axes adapted to a tile's normals against fixed cells of a cube: how many clusters, and what they cost in error."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching, difference, indirect, own
from experiments.rehfeld.sites import by_site, everywhere, tables
from experiments.shared.panels import as_light, groups

TILE = 20  # pixels: about 4,096 clusters of the cars
WAYS = {"adapted axes": ir.Clustered(caches=0, tile=TILE), "fixed 3 x 3 cube faces": ir.CubeFaceClustered(caches=0, tile=TILE)}


def studies() -> Sequence[ir.Study]:
    """Of bent surfaces (the cars) and of flat ones (Sponza)."""
    return everywhere("adapted axes", [own(16), *(caching(distribute=way) for way in WAYS.values())])


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per site and way: clusters, and how far the indirect light is from a cache a pixel."""
    return tables(_table, records)


def _table(records: ir.Records) -> pd.DataFrame:
    exact, rows = indirect(records, 0), {}
    for i, name in enumerate(WAYS):
        clusters = float(records[1 + i].row()["stage.distribute.clusters"])
        rows[name] = {"clusters": clusters, "difference": difference(indirect(records, 1 + i), exact)}
    return pd.DataFrame(rows).T


def chart(*records: ir.Records) -> Figure:
    found, shown = table(*records), {}
    for site, (one,) in by_site(records).items():
        exact, shown[site] = indirect(one, 0), []
        for i, name in enumerate(WAYS):
            row = found.loc[(site, name)]
            title = f"{name}: {row['clusters']:,.0f} clusters, {row['difference']:.1%} off"
            shown[site].append((title, as_light(indirect(one, 1 + i), exact)))
    return groups(shown)
