"""3.2: Axes adapted to a tile's normals against fixed cells of a cube: how many clusters, and what they cost in error."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import SMALL, caching, cars, difference, indirect, own
from experiments.shared.keep import NONE
from experiments.shared.panels import as_light, panels
from experiments.shared.scenes import phong_sponza

TILE = 20  # pixels: about 4,096 clusters of the cars
WAYS = {"adapted axes": ir.Clustered(caches=0, tile=TILE), "fixed 3 x 3 cube faces": ir.CubeFaceClustered(caches=0, tile=TILE)}


def studies() -> Sequence[ir.Study]:
    """Of bent surfaces (the cars) and of flat ones (Sponza)."""
    ways = [own(16), *(caching(distribute=way) for way in WAYS.values())]
    flat = ir.Study(
        name="Rehfeld: adapted axes, Sponza", scenes=[phong_sponza(50)], cameras=["nave"], methods=ways, size=SMALL, bounces=1,
        reference=NONE, repeats=0,
    )  # fmt: skip
    return [cars("adapted axes", ways), flat]


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per scene and way: clusters, and how far the indirect light is from a cache a pixel."""
    rows = {}
    for scene, one in zip(("cars", "Sponza"), records, strict=True):
        exact = indirect(one, 0)
        for i, name in enumerate(WAYS):
            clusters = float(one[1 + i].row()["stage.distribute.clusters"])
            rows[scene, name] = {"clusters": clusters, "difference": difference(indirect(one, 1 + i), exact)}
    return pd.DataFrame(rows).T


def chart(*records: ir.Records) -> Figure:
    found, shown = table(*records), []
    for scene, one in zip(("cars", "Sponza"), records, strict=True):
        exact = indirect(one, 0)
        for i, name in enumerate(WAYS):
            row = found.loc[(scene, name)]
            title = f"{name}: {row['clusters']:,.0f} clusters, {row['difference']:.1%} off"
            shown.append((title, as_light(indirect(one, 1 + i), exact)))
    return panels(shown)
