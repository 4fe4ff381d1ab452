"""When does denoised path tracing win? The least error of each method within every budget up to a second, smaller pictures allowed."""

from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import COLOURS


def scenes() -> list[ir.Scene]:
    """The atrium, and Sponza where it is."""
    try:
        return [ir.scenes.atrium(), ir.load_scene("sponza_crytek/scene.toml")]
    except FileNotFoundError:
        return [ir.scenes.atrium()]


CONES = ir.methods.VoxelConeTracing(shadow=ir.TracedShadows(), glossy=None)

study = ir.Study(
    name="when does denoised path tracing win?",
    scenes=scenes(),
    methods=[
        ir.methods.ConstantAmbient(),
        *ir.sweep(
            CONES,
            {
                "grid.resolution": [32, 64, 128],
                "march.cones": [40, 80],
                "march.correlation": [0.0, 1.0],
                "share": [ir.Interleaved(width=2, height=2), ir.Interleaved(width=4, height=4)],
                "sky": [ir.ConeSky(), ir.TracedSky()],
            },
        ),
        *ir.sweep(
            ir.methods.PathTracingDenoised(bounces=1),
            {"spp": [1, 2, 4, 8], "scale": [0.25, 0.5, 0.75, 1.0], "quality": ["fast", "balanced"]},
        ),
    ],
    size=(480, 270),
    bounces=1,
    reference=ir.Reference(noise=1e-3, max_spp=2048),
    repeats=3,
    max_repeats=7,
    images=False,
)


def chart(records: ir.Records) -> Figure:
    """Least relMSE within a budget against that budget, a panel per scene and a staircase per method."""
    figure = Figure(figsize=(9, 4), layout="constrained")
    table = records.table[records.table["status"] == "ok"]
    panels = list(table.groupby("scene", sort=False))
    for axes, (scene, rows) in zip(figure.subplots(1, len(panels), squeeze=False)[0], panels, strict=True):
        for (method, points), colour in zip(rows.groupby("method", sort=False), COLOURS, strict=False):
            within = points.sort_values("milliseconds")
            least = within["relmse"].cummin()
            axes.step([*within["milliseconds"], 1000], [*least, least.iloc[-1]], where="post", color=colour, label=str(method))
            axes.plot(points["milliseconds"], points["relmse"], ".", color=colour, markersize=3)
        axes.axhline(rows["noise"].max(), color="grey", linestyle=":", label="the truth's noise")
        axes.set(title=scene, xscale="log", yscale="log", xlabel="milliseconds a frame", ylabel="least relMSE within the budget")
        axes.legend(frameon=False)
    return figure
