"""5.2.4: How much indirect light flickers when the camera moves ahead or turns: plain, warped, curved and nested grids."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn, freed
from experiments.shared.flicker import Flicker
from experiments.shared.panels import as_share, panels, picture

SIZE = (320, 180)


GRIDS = (
    "scene's bounds",
    "about the camera, snapped",
    "about the camera, not snapped",
    "spline warp",
    "perspective warp",
    "spherical warp",
    "spherical warp, not snapped",
    "nested grids",
)
TURNING = ", turning"
NAMES = (*GRIDS, *(name + TURNING for name in GRIDS))
TURN = 0.5  # degrees a frame: about a voxel of the view volumes


def grids() -> list[ir.Grid]:
    """128 voxels along each side, by name; over the scene's bounds but for those that are about the camera by their nature. Nested grids:
    64 twice, as fine as the others near the camera."""
    return [
        ir.Grid(resolution=128),
        ir.Grid(resolution=128, region=ir.AroundCamera(step=1)),
        ir.Grid(resolution=128, region=ir.AroundCamera(step=0)),
        ir.Grid(resolution=128, warp=ir.CubicSpline(alpha=0.25)),
        ir.Grid(resolution=128, warp=ir.Perspective()),
        ir.Grid(resolution=128, warp=ir.Spherical()),
        ir.Grid(resolution=128, warp=ir.Spherical(snap=False)),
        ir.Grid(resolution=64, cascades=2),
    ]


def flickering(**changes: object) -> Flicker:
    """Freed's method in motion, diffuse light only: a reflection may change as the camera moves, diffuse light may not."""
    kept = {name: getattr(freed(), name) for name in ("voxelize", "light_voxels", "prefilter", "march", "share", "shadow", "sky")}
    return Flicker(**{**kept, "glossy": None, **changes})


def studies() -> Sequence[ir.Study]:
    return [drawn("flicker of warps", [flickering(grid=grid, turn=turn) for turn in (0.0, TURN) for grid in grids()], size=SIZE)]


def means(records: ir.Records) -> dict[str, float]:
    """Name of the grid -> mean change between frames, as a share of the mean indirect radiance."""
    return dict(zip(NAMES, records.table["stage.flicker.mean"] / 1e6, strict=True))


def chart(records: ir.Records) -> Figure:
    highest = max(float(np.percentile(picture(records, i), 99)) for i in range(len(records)))
    shown = [(f"{name}\nmean {mean:.3f}", as_share(picture(records, i) / highest)) for i, (name, mean) in enumerate(means(records).items())]
    return panels(shown, columns=4, width=3.2, title="change of indirect light between frames at surface points, share of its mean")
