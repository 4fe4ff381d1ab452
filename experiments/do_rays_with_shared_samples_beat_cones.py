"""Do traced rays with shared samples beat cones? Error against the march's time: cones, rays of each pixel, rays shared by a tile."""

from matplotlib.figure import Figure

import interreflect as ir

cones = ir.methods.VoxelConeTracing()

study = ir.Study(
    name="do traced rays with shared samples beat cones?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(cones, {"march.cones": [6, 12, 24, 40, 80]})
    + ir.sweep(cones.replace({"march": ir.TracedRays()}), {"march.tile": [1, 16], "march.samples": [4, 16, 64, 256]}),
    size=(320, 180),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=512),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the march's time, a line per kind of march; along a line, more cones or rays."""
    return ir.charts.curves(records, x="stage.march.milliseconds", by=["march", "march.tile"], x_label="time of the march, ms (median)")
