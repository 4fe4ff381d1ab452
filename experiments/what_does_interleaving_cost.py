"""What does interleaving cost? Error and time of the march when each pixel of a block does a part of the cones."""

from matplotlib.figure import Figure

import interreflect as ir

study = ir.Study(
    name="what does interleaving cost?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(
        ir.methods.VoxelConeTracing(),
        {"march.cones": [16, 64], "share": [ir.EveryPixel(), *(ir.Interleaved(width=n, height=n) for n in (2, 4, 8))]},
    ),
    size=(320, 180),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=512),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the march's time, a line per number of cones; blocks grow from right to left, from 1 x 1 to 8 x 8."""
    return ir.charts.curves(records, x="stage.march.milliseconds", by=["march.cones"], x_label="time of the march, ms (median)")
