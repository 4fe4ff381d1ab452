"""How fine must voxels be? Error of voxel cone tracing against the grid's resolution, for three ways to filter opacity."""

from matplotlib.figure import Figure

import interreflect as ir

study = ir.Study(
    name="how fine must voxels be?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(
        ir.methods.VoxelConeTracing(),
        {"prefilter": [ir.VolumeCoverage(), ir.SurfaceCoverage(), ir.OctantCoverage()], "grid.resolution": [16, 32, 64, 128, 256]},
    ),
    size=(480, 270),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=1e-3, max_spp=2048),
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against resolution, a line per filter."""
    return ir.charts.curves(records, x="grid.resolution", by=["prefilter"], x_label="cells along the scene's longest side")
