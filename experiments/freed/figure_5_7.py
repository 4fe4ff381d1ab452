"""Figure 5.7: The scene coloured by how dense a warp's voxels are along x: blue twice as dense as without, green as without."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.density_picture import DensityPicture
from experiments.shared.panels import as_share, panels, picture

NAMES = ("spline warp, alpha 0.25", "logistic warp, steepness 6")


def studies() -> Sequence[ir.Study]:
    warps = [ir.CubicSpline(alpha=0.25), ir.Logistic(steepness=6.0)]
    return [drawn("density of a warp", [DensityPicture(grid=ir.Grid(resolution=256, warp=warp)) for warp in warps])]


def chart(records: ir.Records) -> Figure:
    shown = [(name, as_share(picture(records, i))) for i, name in enumerate(NAMES)]
    return panels(shown, title="density along x: red none, green as without warp, blue twice as dense")
