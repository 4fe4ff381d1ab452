"""Figure 6: Clustered and equidistant caches, and where they stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching, difference, indirect, own
from experiments.rehfeld.sites import by_site, everywhere, tables
from experiments.shared.cache_picture import CachePicture
from experiments.shared.panels import Image, as_colour, as_light, groups

WAYS = {"clustered": ir.Clustered(caches=4096), "equidistant": ir.Equidistant(caches=4096)}


def studies() -> Sequence[ir.Study]:
    shared = [caching(distribute=way) for way in WAYS.values()]
    places = [CachePicture.preset("Rehfeld 2014").replace({"distribute": way, "show": "places"}) for way in WAYS.values()]
    return [*everywhere("distributions", [own(16), *shared], bent=True), *everywhere("places of the caches", places, bent=True)]


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per site and way: share of the surface's pixels without a cache, and how far the indirect light is from a cache a pixel."""
    return tables(_table, records)


def _table(records: ir.Records, _places: ir.Records) -> pd.DataFrame:
    exact, rows = indirect(records, 0), {}
    for i, name in enumerate(WAYS):
        counts = records[1 + i].row()
        without = float(np.nan_to_num(counts.get("stage.interpolate.uncovered_pixels", 0)))
        seen = without + float(counts["stage.interpolate.covered_pixels"])
        rows[name] = {"uncovered": without / seen, "difference": difference(indirect(records, 1 + i), exact)}
    return pd.DataFrame(rows).T


def chart(*records: ir.Records) -> Figure:
    found = table(*records)
    return groups({site: _shown(*its, found.loc[site]) for site, its in by_site(records).items()}, columns=3)


def _shown(records: ir.Records, places: ir.Records, found: pd.DataFrame) -> list[tuple[str, Image]]:
    exact, shown = indirect(records, 0), []
    for i, name in enumerate(WAYS):
        row = found.loc[name]
        title = f"{name}: {row['uncovered']:.2%} of the pixels without a cache, {row['difference']:.1%} off"
        shown.append((title, as_light(indirect(records, 1 + i), exact)))
    shown.append(("a cache at every pixel", as_light(exact, exact)))
    return shown + [(f"{name}: where they stand", as_colour(places.images(places[i])[0])) for i, name in enumerate(WAYS)]
