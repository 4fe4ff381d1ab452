"""Where should caches stand? Error against their number: axes adapted to the normals, fixed cells of a cube, or evenly spread tiles."""

from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.glossy import glossy_scenes

COUNTS = (256, 1024, 4096)
WAYS = (ir.Clustered, ir.CubeFaceClustered, ir.Equidistant)

study = ir.Study(
    name="where should caches stand?",
    scenes=[*glossy_scenes(), ir.scenes.grille()],
    methods=ir.sweep(ir.methods.ClusteredRadianceCaching(), {"distribute": [way(caches=count) for way in WAYS for count in COUNTS]}),
    size=(640, 360),
    bounces=1,
    reference=ir.Reference(noise=5e-3, max_spp=256),
    repeats=0,
)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the number of caches, a line per distribution."""
    return ir.charts.curves(records, x="stage.distribute.caches", by=["distribute"], x_label="caches")
