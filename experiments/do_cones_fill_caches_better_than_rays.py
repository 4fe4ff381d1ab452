"""Do cones fill caches better than rays? Error against the filling's time: one cone a texel, or so many rays, at several resolutions."""

from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.glossy import glossy_scenes

RESOLUTIONS = (8, 16, 32)
FILLS = [
    *(ir.ConeFill(resolution=n) for n in RESOLUTIONS),
    *(ir.TracedFill(resolution=n, samples=samples) for n in RESOLUTIONS for samples in (1, 4, 16)),
]

study = ir.Study(
    name="do cones fill caches better than rays?",
    scenes=glossy_scenes(),
    methods=ir.sweep(ir.methods.ClusteredRadianceCaching(distribute=ir.Clustered(caches=2048)), {"fill": FILLS}),
    size=(640, 360),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the time of filling, a line per way and resolution; along a line, more rays."""
    return ir.charts.curves(
        records, x="stage.fill.milliseconds", by=["fill", "fill.resolution"], x_label="time of filling the caches, ms (median)"
    )
