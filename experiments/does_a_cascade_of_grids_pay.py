"""Does a cascade of grids pay? Caches in one grid, of ever more cells, and in three over each other, of which far pixels read the coarse
ones: lit are those alone that pixels read. The paper names it as future work."""

from matplotlib.figure import Figure

import interreflect as ir

SIDES = ((12, 6, 12), (24, 12, 24), (36, 18, 36), (48, 24, 48))
composition = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=16384), link=ir.ShLinks(links=128), lit_caches="read",
)  # fmt: skip
grids = [ir.CacheGrid(nx=nx, ny=ny, nz=nz, levels=levels, reach=4.0) for nx, ny, nz in SIDES for levels in (1, 3)]
study = ir.Study(
    name="does a cascade of grids pay?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=[composition.replace(place_caches=grid) for grid in grids],
    size=(640, 360),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=9,
    max_repeats=30,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the frame's time, a line for one grid and for three; along a line, more cells."""
    return ir.charts.curves(records, x="milliseconds", by=["place_caches.levels"], x_label="frame, ms (median)")
