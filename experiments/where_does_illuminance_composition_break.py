"""Where does illuminance composition break? The value at which each failure crosses its tolerance, for kinds of links, of clusters, of
surfels and of caches: leaks, steps where links change, texels in solids, negative light, colours, walls in cells, far light.

Atlases, not a study of pictures; every measured setting is kept, so it resumes.
`python -m experiments.where_does_illuminance_composition_break` prints the break points; `./run figures
where_does_illuminance_composition_break` draws them too.
"""

from __future__ import annotations

from pathlib import Path

import interreflect as ir
from experiments.shared.atlases import Atlases, Wanted, chart, measured, table
from experiments.shared.keep import FOLDER

__all__ = ["chart", "measure"]

# A room's worth of surfels and caches.
caches = ir.LightMap(texels=64, grid=ir.CacheGrid(nx=8, ny=8, nz=8))
base = ir.methods.IlluminanceComposition(place_surfels=ir.HaltonSurfels(surfels=8192), place_caches=caches)

linked = {
    "ShLinks": base,
    "rays to surfels alone": base.replace({"link.near_rays": 0}),  # as the paper's
    "RuntimeProjection": base.replace(link=ir.RuntimeProjection()),
    "kd-tree": base.replace(cluster_surfels=ir.KdTree()),
    "clusters without normals": base.replace({"cluster_surfels.normal_weight": 0.0}),
    "relaxed surfels": base.replace(place_surfels=ir.RelaxedSurfels(surfels=8192)),
    "random surfels": base.replace(place_surfels=ir.XorshiftSurfels(surfels=8192)),
    "32 links": base.replace({"link.links": 32}),
    "254 links": base.replace({"link.links": 254}),
}

placed = {
    "a map of 64": base,
    "a map of 128": base.replace({"place_caches.texels": 128}),
    "a grid, walls left out": base.replace(place_caches=caches.grid),
    "a grid, all cells": base.replace(place_caches=caches.grid.replace(most_backs=1.0)),
}

reflected = {
    **{f"{bands} bands": base.replace({"link.bands": bands}) for bands in (2, 3, 4, 6, 8)},
    "RuntimeProjection, 4 bands": base.replace(link=ir.RuntimeProjection()),
}

OF_LINKS = ("leak between corridors by links", "discontinuity between few links", "far light by links", "far light by surfels")

ATLASES: Wanted = {
    "linked": (linked, OF_LINKS),
    "placed": (placed, ("texels behind other geometry", "bleeding through a cell", "bleeding through a grid of probes")),
    "reflected": (reflected, ("negative radiance about a patch", "chrominance of few bands")),
}


def measure(folder: Path, atlases: Wanted = ATLASES, sweep: int = 5, bisections: int = 2) -> Atlases:
    """The atlases by name; break points as `break_points.csv` and pages of pictures in `folder`. One seed: errors are far above noise."""
    return measured(folder, atlases, (0,), sweep, bisections)


if __name__ == "__main__":
    for title, one in measure(FOLDER / "where_does_illuminance_composition_break").items():
        print(f"{title}: where each failure crosses its tolerance\n{table(one).to_string()}\n")
