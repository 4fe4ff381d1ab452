"""What does a turned scene cost? Indirect light and its error in a Cornell box that is turned against the grid, for each filter and with
correlated steps. Scenes along the grid flatter voxels: what looks best there may be worst elsewhere."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.placed import placed, turned
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

DEGREES = (0, 10, 20, 30, 45)
AXIS = (1, 2, 3)
FILTERS = (
    ir.SurfaceCoverage(),
    ir.SurfaceCoverage(opacity="columns"),
    ir.OctantCoverage(),
    ir.OctantCoverage(opacity="columns"),
    ir.SphericalHarmonicVoxels(),
)

boxes = {placed(ir.scenes.cornell_box(), turn=turned(degrees, AXIS)): degrees for degrees in DEGREES}

study = ir.Study(
    name="what does a turned scene cost?",
    scenes=list(boxes),
    methods=ir.sweep(ir.methods.VoxelConeTracing(), {"prefilter": list(FILTERS), "march.correlation": [0.0, 1.0]}),
    size=(320, 180),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=512),
    repeats=0,
)


def table(records: ir.Records) -> pd.DataFrame:
    """A row per filter, correlation and turn: `degrees`, `energy` (indirect light over the truth's) and `error` (its relMSE)."""
    degrees = {box.hash: turn for box, turn in boxes.items()}
    found = records.table
    name = found["prefilter"].astype(str) + found["prefilter.opacity"].map(lambda word: ", columns" if word == "columns" else "")
    return pd.DataFrame(
        {
            "filter": name,
            "correlation": found["march.correlation"],
            "degrees": [degrees[record.scene_hash] for record in records],
            "energy": found["indirect_energy_ratio"],
            "error": found["indirect_relmse"],
        }
    ).sort_values(["filter", "correlation", "degrees"], ignore_index=True)


def chart(records: ir.Records) -> Figure:
    """Energy and error of indirect light against the turn. Dashed: correlated steps."""
    figure = new_figure((9.6, 4.6), dark=False)
    both = figure.subplots(1, 2)
    found = table(records)
    names = list(dict.fromkeys(found["filter"]))
    titles = {"energy": "indirect light / the truth's", "error": "relMSE of indirect light"}
    for axes, (column, title) in zip(both, titles.items(), strict=True):
        for (name, correlation), rows in found.groupby(["filter", "correlation"]):
            i = names.index(name)
            axes.plot(
                rows["degrees"], rows[column], color=COLOURS[i], marker=MARKERS[i], linestyle="--" if correlation else "-",
                label=None if correlation else name,
            )  # fmt: skip
        axes.set(xlabel=f"turn about {AXIS}, degrees", ylabel=title)
        dress(axes, dark=False)
    both[1].set_yscale("log")
    add_legend(figure, both, dark=False)
    return figure
