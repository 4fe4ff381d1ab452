"""Figure 3: Radiance caches of 64 x 64 texels, filled by cones; beside them the same filled by rays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import difference
from experiments.rehfeld.sites import by_site, everywhere
from experiments.shared.cache_picture import CachePicture
from experiments.shared.panels import as_light, groups

SIDE, ACROSS, DOWN = 64, 6, 3


def studies() -> Sequence[ir.Study]:
    by_cones = CachePicture.preset("Rehfeld 2014").replace(
        {"show": "maps", "maps": ACROSS, "fill.resolution": SIDE, "distribute": ir.Clustered(caches=256)}
    )
    by_rays = by_cones.replace({"fill": ir.TracedFill(resolution=SIDE, samples=16)})
    return everywhere("maps of caches", [by_cones, by_rays], size=(SIDE * ACROSS, SIDE * DOWN))


def chart(*records: ir.Records) -> Figure:
    shown = {}
    for site, (one,) in by_site(records).items():
        cones, rays = (np.asarray(one.images(record)[0]) for record in one)
        shown[f"{site}: radiance caches of 64 x 64 texels, hemispheres about the surface's normal, of equal solid angles"] = [
            (f"one cone a texel, {difference(cones, rays):.1%} off", as_light(cones, rays)),
            ("16 rays a texel, against the triangles", as_light(rays, rays)),
        ]
    return groups(shown)
