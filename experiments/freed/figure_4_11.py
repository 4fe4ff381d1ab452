"""Figure 4.11: The voxels that a perspective warp makes of a view frustum, seen from outside."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.frustum_picture import FrustumPicture
from experiments.shared.panels import as_colour, panels, picture

NAMES = ("perspective, linear depth", "perspective, hyperbolic depth", "spherical")


def studies() -> Sequence[ir.Study]:
    """Few voxels, so that one sees each."""
    warps = [ir.Perspective(linear_depth=True), ir.Perspective(linear_depth=False), ir.Spherical()]
    return [drawn("voxels of a view frustum", [FrustumPicture(grid=ir.Grid(resolution=32, warp=warp)) for warp in warps])]


def chart(records: ir.Records) -> Figure:
    return panels([(name, as_colour(picture(records, i))) for i, name in enumerate(NAMES)], columns=3)
