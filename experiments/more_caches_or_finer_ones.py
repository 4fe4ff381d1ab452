"""More caches or finer ones? Error against time for 256 to 8,192 caches of 8 x 8, 16 x 16 and 32 x 32 texels, on glossy scenes."""

from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.glossy import glossy_scenes

study = ir.Study(
    name="more caches or finer ones?",
    scenes=glossy_scenes(),
    methods=ir.sweep(
        ir.methods.ClusteredRadianceCaching(), {"fill.resolution": [8, 16, 32], "distribute.caches": [256, 1024, 2048, 4096, 8192]}
    ),
    size=(640, 360),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the frame's time, a line per resolution; along a line, more caches."""
    return ir.charts.curves(records, x="milliseconds", by=["fill.resolution"], x_label="time of a frame, ms (median)")
