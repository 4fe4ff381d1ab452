"""How many cones? Error of voxel cone tracing against the number of cones over the hemisphere, for two resolutions of the voxels."""

from matplotlib.figure import Figure

import interreflect as ir

study = ir.Study(
    name="how many cones?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(ir.methods.VoxelConeTracing(), {"grid.resolution": [32, 128], "march.cones": [3, 6, 12, 24, 40, 80, 160]}),
    size=(320, 180),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=512),
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the number of cones, a line per resolution."""
    return ir.charts.curves(records, x="march.cones", by=["grid.resolution"], x_label="cones over the hemisphere")
