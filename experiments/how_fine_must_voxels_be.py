"""How fine must voxels be? Error of voxel cone tracing against the grid's resolution, for two ways to filter opacity."""

from matplotlib.figure import Figure

import interreflect as ir

study = ir.Study(
    name="how fine must voxels be?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=ir.sweep(
        ir.methods.VoxelConeTracing(),
        {"prefilter": [ir.VolumeCoverage(), ir.SurfaceCoverage()], "grid.resolution": [16, 32, 64, 128, 256]},
    ),
    size=(480, 270),
    seeds=range(3),
    bounces=1,
    reference=ir.Reference(noise=1e-3, max_spp=2048),
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against resolution, a panel per scene; bars reach from the least to the largest error of the seeds."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    table = records.table[records.table["status"] == "ok"]
    scenes = list(table.groupby("scene", sort=False))
    for axes, (scene, rows) in zip(figure.subplots(1, len(scenes), squeeze=False)[0], scenes, strict=True):
        for (prefilter, points), colour in zip(rows.groupby("prefilter", sort=False), ir.charts.COLOURS, strict=False):
            error = points.groupby("grid.resolution")["indirect_relmse"].agg(["mean", "min", "max"])
            reach = [error["mean"] - error["min"], error["max"] - error["mean"]]
            axes.errorbar(error.index, error["mean"], yerr=reach, color=colour, marker="o", capsize=3, label=str(prefilter))
        axes.axhline(rows["indirect_noise"].max(), color="grey", linestyle=":", label="the truth's noise")
        axes.set(title=scene, xscale="log", yscale="log", xlabel="cells along the scene's longest side", ylabel="relMSE of indirect light")
        axes.set_xticks(sorted(rows["grid.resolution"].unique()), labels=[f"{n:g}" for n in sorted(rows["grid.resolution"].unique())])
        axes.minorticks_off()
        axes.legend(frameon=False)
    return figure
