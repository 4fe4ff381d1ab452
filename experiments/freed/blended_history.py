"""4.7.2: Does blending in the last frame's radiance lessen flicker?"""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.flicker_of_warps import SIZE, flickering
from experiments.freed.pipeline import drawn, freed
from experiments.shared.panels import as_share, panels, picture

WEIGHTS = (0.0, 0.5, 0.9)


def studies() -> Sequence[ir.Study]:
    """In a grid about the camera that is not snapped: there the voxels change although nothing moves but the camera."""
    grid = ir.Grid(resolution=128, region=ir.AroundCamera(step=0))
    inner = freed().light_voxels
    ways = [inner, *(ir.BlendHistory(light_voxels=inner, weight=weight) for weight in WEIGHTS[1:])]
    return [drawn("last frame blended in", [flickering(grid=grid, light_voxels=way) for way in ways], size=SIZE)]


def means(records: ir.Records) -> dict[float, float]:
    """Weight of the last frame -> mean change between frames, as a share of the mean indirect radiance."""
    return dict(zip(WEIGHTS, records.table["stage.flicker.mean"] / 1e6, strict=True))


def chart(records: ir.Records) -> Figure:
    highest = max(float(picture(records, i).mean()) for i in range(len(records))) * 8
    named = enumerate(means(records).items())
    shown = [
        (f"weight {weight:g} of the last frame\nmean change {mean:.3f}", as_share(picture(records, i) / highest))
        for i, (weight, mean) in named
    ]
    return panels(shown, columns=3, width=3.6, title="change of indirect light between frames, grid about the camera, not snapped")
