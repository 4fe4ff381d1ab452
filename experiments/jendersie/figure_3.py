"""Figure 3: Thirty thousand surfels placed at random, by Halton's points, and by relaxing these."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import replaced, study
from experiments.shared.composition_picture import MILLIONTHS, CompositionPicture
from experiments.shared.panels import as_share, panels, picture

SURFELS = 30_000
WAYS = {
    "Xorshift": ir.XorshiftSurfels(surfels=SURFELS),
    "Halton": ir.HaltonSurfels(surfels=SURFELS),
    "relaxed": ir.RelaxedSurfels(surfels=SURFELS),
}


def studies() -> Sequence[ir.Study]:
    """Clusters and caches are not what is looked at: few, quickly made."""
    plain = CompositionPicture(show="surfels", cluster_surfels=ir.KdTree(), place_caches=ir.CacheGrid(nx=1, ny=1, nz=1, most_backs=1.0))
    few = replaced(plain, link__links=1, link__bands=1)
    return [study("placed surfels", [few.replace(place_surfels=way) for way in WAYS.values()], size=(960, 540))]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way: `nearest`, mean distance to the nearest neighbour over a hexagonal grid's; `deviation` of it (blue noise is even:
    far, and all alike; by chance, mean sqrt(pi / 4) / 1.07 = .466 and deviation .243); `gaps`, share of the surface beyond all disks."""
    rows = {}
    for name, record in zip(WAYS, records, strict=True):
        counts = record.stages["picture"]["counts"]
        rows[name] = {
            "nearest": counts["spacing_mean"] / MILLIONTHS,
            "deviation": counts["spacing_deviation"] / MILLIONTHS,
            "gaps": counts["gaps"] / counts["pixels"],
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    names = [
        f"{name}: nearest {row['nearest']:.2f} (deviation {row['deviation']:.2f}) of a hexagonal grid, {row['gaps']:.0%} gaps"
        for name, row in table(records).iterrows()
    ]
    return panels([(name, as_share(picture(records, i))) for i, name in enumerate(names)], columns=1, width=8.0)
