"""Does a finer mip filter beat more steps? Error of voxel cone tracing against the time of the march, for each filter and step length."""

from matplotlib.figure import Figure

import interreflect as ir

study = ir.Study(
    name="does a finer mip filter beat more steps?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(
        ir.methods.VoxelConeTracing(),
        {"prefilter": [technique() for technique in ir.techniques("prefilter")], "march.step": [1.5, 1.0, 0.75, 0.5, 0.25]},
    ),
    size=(320, 180),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=512),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the march's time, a line per filter; along a line, steps get shorter to the right."""
    return ir.charts.curves(records, x="stage.march.milliseconds", by=["prefilter"], x_label="time of the march, ms (median)")
