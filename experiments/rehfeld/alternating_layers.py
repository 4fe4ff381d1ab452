"""4: A step of half the cone's diameter resolves alternating opaque and empty voxels; a full diameter does not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import NONE
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure

STEPS = (0.25, 0.5, 1.0)
RESOLUTION = 64


def studies() -> Sequence[ir.Study]:
    """Cones of no width through the finest level, one straight up from every pixel: as in the papers, and with each step's opacity
    corrected for its length."""
    cone = ir.VoxelCones(half_angle=0.0, first_diameter=1.0, level_bias=0.0, density=1.0)
    grid = ir.Grid(resolution=RESOLUTION)
    ways = [
        ir.methods.VoxelConeTracing(
            grid=grid, prefilter=ir.SurfaceCoverage(), glossy=None, shadow=cone.replace(step=step, opacity_correction=corrected)
        )
        for corrected in (False, True)
        for step in STEPS
    ]
    scenes = [ir.scenes.opaque_layer(cells=RESOLUTION)]
    return [ir.Study(name="Rehfeld: one opaque layer", scenes=scenes, methods=ways, size=(160, 90), bounces=0, reference=NONE, repeats=0)]


def openness(records: ir.Records, corrected: bool = False) -> dict[float, np.ndarray]:
    """Step -> what the cones leave open below the layer, across the picture. Right: 0 everywhere."""
    found = {}
    for i, step in enumerate(STEPS):
        image, indirect = records.images(records[i + (len(STEPS) if corrected else 0)])
        found[step] = (image - indirect).mean((0, 2))
    return found


def chart(records: ir.Records) -> Figure:
    figure = new_figure((8.0, 3.4), dark=False)
    both = figure.subplots(1, 2, sharey=True)
    for axes, corrected in zip(both, (False, True), strict=True):
        for (step, opened), colour in zip(openness(records, corrected).items(), COLOURS, strict=False):
            axes.plot(opened, color=colour, label=f"steps of {step:g} diameters")
        axes.set(xlabel="column of the picture: the floor rises by two voxels", ylabel="open below an opaque layer (right: 0)")
        axes.set_title("opacity corrected for the step's length" if corrected else "as in the paper", fontsize=9)
        dress(axes, dark=False)
    add_legend(figure, both, dark=False)
    return figure
