"""What do caches buy over cones of each pixel? Error against time: clustered caches, cones at every pixel, and interleaved cones."""

from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.glossy import glossy_scenes

cones = ir.methods.VoxelConeTracing()
every = cones.replace({"share": ir.EveryPixel()})

study = ir.Study(
    name="what do caches buy?",
    scenes=glossy_scenes(),
    methods=ir.sweep(ir.methods.ClusteredRadianceCaching(), {"distribute.caches": [256, 1024, 4096, 8192]})
    + ir.sweep(every, {"march.cones": [6, 12, 24, 40]})
    + ir.sweep(cones, {"march.cones": [12, 40]}),
    size=(1280, 720),
    bounces=1,
    reference=ir.Reference(noise=1e-2, max_spp=64),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the frame's time, a line per method and way of sharing; along a line, more caches or cones."""
    return ir.charts.curves(records, x="milliseconds", by=["method", "share"], x_label="time of a frame, ms (median)")
