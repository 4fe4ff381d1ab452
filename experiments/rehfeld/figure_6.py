"""Figure 6: Clustered and equidistant caches, and where they stand."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching, cars, difference, indirect, own
from experiments.shared.cache_picture import CachePicture
from experiments.shared.panels import as_colour, as_light, panels

WAYS = {"clustered": ir.Clustered(caches=4096), "equidistant": ir.Equidistant(caches=4096)}
CAMERA = "grille"


def studies() -> Sequence[ir.Study]:
    shared = [caching(distribute=way) for way in WAYS.values()]
    places = [CachePicture.preset("Rehfeld 2014").replace({"distribute": way, "show": "places"}) for way in WAYS.values()]
    return [cars("distributions", [own(16), *shared], camera=CAMERA), cars("places of the caches", places, camera=CAMERA)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way: pixels without a cache, of those that see a surface, and how far the indirect light is from a cache a pixel."""
    exact, rows = indirect(records, 0), {}
    for i, name in enumerate(WAYS):
        counts = records[1 + i].row()
        without = float(np.nan_to_num(counts.get("stage.interpolate.uncovered_pixels", 0)))
        seen = without + float(counts["stage.interpolate.covered_pixels"])
        rows[name] = {"uncovered": without / seen, "difference": difference(indirect(records, 1 + i), exact)}
    return pd.DataFrame(rows).T


def chart(records: ir.Records, places: ir.Records) -> Figure:
    exact, found = indirect(records, 0), table(records)
    pictures = []
    for i, name in enumerate(WAYS):
        row = found.loc[name]
        title = f"{name}: {row['uncovered']:.2%} of the pixels without a cache, {row['difference']:.1%} off"
        pictures.append((title, as_light(indirect(records, 1 + i), exact)))
    pictures.append(("a cache at every pixel", as_light(exact, exact)))
    pictures += [(f"{name}: where they stand", as_colour(places.images(places[i])[0])) for i, name in enumerate(WAYS)]
    return panels(pictures, columns=3)
