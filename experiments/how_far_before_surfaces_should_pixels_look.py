"""How far before their surfaces should pixels look into a grid of caches? On the surface itself, as in the paper, half of the caches
about a pixel may lie behind its wall; further away lie caches that see what the pixel does not."""

from matplotlib.figure import Figure

import interreflect as ir

composition = ir.methods.IlluminanceComposition(place_surfels=ir.HaltonSurfels(surfels=16384), link=ir.ShLinks(links=254))
grids = [ir.CacheGrid(nx=n, ny=2 * n // 3, nz=n, normal_offset=offset) for n in (12, 24) for offset in (0.0, 0.125, 0.25, 0.5, 1.0)]
study = ir.Study(
    name="how far before surfaces should pixels look?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=[composition.replace(place_caches=grid) for grid in grids],
    size=(320, 180),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=1,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the distance, in cells, a line for each grid."""
    return ir.charts.curves(records, x="place_caches.normal_offset", by=["place_caches.nx"], x_label="look before the surface, cells")
