"""Where do shared caches break? The value at which each failure crosses its tolerance, for every way to place caches, to read them, to
hold them, and in motion: grilles, leaves and wires without a cache, sharp lobes, tiles of nothing but sky, pops in a slow pan.

Atlases, not a study of pictures; every measured setting is kept, so it resumes. `python -m experiments.where_do_caches_break` prints the
break points; `./run figures where_do_caches_break` draws them too.
"""

from __future__ import annotations

from pathlib import Path

import interreflect as ir
from experiments.shared.atlases import Atlases, Wanted, chart, measured, table
from experiments.shared.keep import FOLDER

__all__ = ["chart", "measure"]

FAILURES = (
    "pixels without a cache behind a grille",
    "pixels without a cache in foliage",
    "pixels without a cache on wires",
    "pixels without light",
    "reflection in a sharp lobe",
    "tiles that see the sky alone",
    "popping behind a grille",
    "popping at a depth edge",
)
TILE = 8  # pixels: pictures of failures are small; the paper's tiles are 22 pixels wide in a picture 1742 wide

base = ir.methods.ClusteredRadianceCaching(grid=ir.Grid(resolution=64), distribute=ir.Clustered(caches=0, tile=TILE))

placed = {
    name: base.replace(distribute=distribute)
    for name, distribute in {
        "Clustered": base.distribute,
        "Clustered, cubes": ir.Clustered(caches=0, tile=TILE, slice_depth=1),
        "Clustered, not by depth": ir.Clustered(caches=0, tile=TILE, slice_depth=0),
        "CubeFaceClustered": ir.CubeFaceClustered(caches=0, tile=TILE),
        "Equidistant": ir.Equidistant(caches=0, tile=TILE),
        "ReuseCaches": ir.ReuseCaches(distribute=base.distribute),
        "Clustered, tiles of 16": ir.Clustered(caches=0, tile=2 * TILE),
    }.items()
}

read = {
    "Gather": base,
    "Gather, one tile": base.replace({"interpolate.radius": 1.0}),
    "Gather, half a tile": base.replace({"interpolate.radius": 0.5}),
    "Gather, half a tile in space": base.replace({"interpolate.world_radius": 0.5}),
    "Gather, two tiles in space": base.replace({"interpolate.world_radius": 2.0}),
    "Gather, 30 degrees": base.replace({"interpolate.max_angle": 30.0}),
    "Splat": base.replace(interpolate=ir.Splat()),
    "Splat, minimum": base.replace(interpolate=ir.Splat(weight="minimum")),
}

PAPERS = ir.MipChain(width="one_percent", level_bias=0.0)
held = {
    name: base.replace({"interpolate": ir.Evaluated(), "fill.resolution": texels, "preconvolve": preconvolve})
    for name, texels, preconvolve in (
        ("8, 1 %", 8, PAPERS),
        ("16, 1 %", 16, PAPERS),
        ("32, 1 %", 32, PAPERS),
        ("16, resultant", 16, ir.MipChain(level_bias=0.0)),
        ("32, resultant", 32, ir.MipChain(level_bias=0.0)),
        ("16, resultant, finer by 1", 16, ir.MipChain()),
        ("32, resultant, finer by 1", 32, ir.MipChain()),
        ("8, integral", 8, ir.LobeIntegral()),
        ("16, integral", 16, ir.LobeIntegral()),
        ("32, integral", 32, ir.LobeIntegral()),
    )
}

ATLASES: Wanted = {"placed": (placed, FAILURES), "read": (read, FAILURES), "held": (held, ("reflection in a sharp lobe",))}


def measure(folder: Path, atlases: Wanted = ATLASES, sweep: int = 7, bisections: int = 2) -> Atlases:
    """The atlases by name; break points as `break_points.csv` and pages of pictures in `folder`. One seed: cones make no noise."""
    return measured(folder, atlases, (0,), sweep, bisections)


if __name__ == "__main__":
    for title, one in measure(FOLDER / "where_do_caches_break").items():
        print(f"{title}: where each failure crosses its tolerance\n{table(one).to_string()}\n")
