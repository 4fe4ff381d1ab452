"""Must caches be lit that no pixel reads? The same pictures by lighting all caches, as in the paper, and those alone that the frame's
pixels read, at several numbers of links: at equal time, more links for the caches that count."""

from matplotlib.figure import Figure

import interreflect as ir

composition = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=16384), place_caches=ir.LightMap(texels=128), link=ir.ShLinks(links=128),
)  # fmt: skip
study = ir.Study(
    name="must caches be lit that no pixel reads?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(composition, {"link.links": [32, 64, 128, 254], "lit_caches": ["all", "read"]}),
    size=(640, 360),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=9,
    max_repeats=30,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the frame's time, a line for all caches and for those that are read; along a line, more links."""
    return ir.charts.curves(records, x="milliseconds", by=["lit_caches"], x_label="frame, ms (median)")
