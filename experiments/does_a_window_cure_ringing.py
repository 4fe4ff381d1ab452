"""Does a window cure ringing? Glossy light of a small bright patch through caches of few and many bands, without a window, by Hanning's and
by Lanczos's: what softer light loses against what fewer false rings win."""

from matplotlib.figure import Figure

import interreflect as ir

composition = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=4096), place_caches=ir.LightMap(texels=64, grid=ir.CacheGrid(nx=8, ny=8, nz=8)),
    link=ir.ShLinks(links=128),
)  # fmt: skip
study = ir.Study(
    name="does a window cure ringing?",
    scenes=[ir.scenes.glossy_receiver(spot=spot, exponent=exponent) for spot in (4, 16) for exponent in (10.0, 50.0)],
    methods=ir.sweep(composition, {"link.bands": [3, 4, 6, 8], "evaluate.window": ["none", "hanning", "lanczos"]}),
    size=(320, 240),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=1024),
    repeats=1,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against bands, a line per window."""
    return ir.charts.curves(records, x="link.bands", by=["evaluate.window"], x_label="bands")
