"""Do warped grids pay at all? The error of indirect light in each warp over that in even voxels, as many of them, on every scene, beside
what twice the resolution brings; views from inside a scene apart from those from outside."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.places import scenes
from experiments.shared.ratios import over, ratio, strips
from interreflect.study.configurations import configurations

RESOLUTIONS = (32, 64, 128)
EVEN = "even"
GRIDS: Mapping[str, ir.Grid] = {
    EVEN: ir.Grid(),
    "CubicSpline": ir.Grid(warp=ir.CubicSpline()),
    "Logistic": ir.Grid(warp=ir.Logistic()),
    "Perspective": ir.Grid(warp=ir.Perspective()),
    "Spherical": ir.Grid(warp=ir.Spherical()),
}
INSIDE, OUTSIDE = "seen from inside", "seen from outside"
# A pixel's cones are its own, so that nothing but the grid differs; rays see the sky, as a view volume leaves walls out.
base = ir.methods.VoxelConeTracing(glossy=None, share=ir.EveryPixel(), sky=ir.TracedSky(samples=16, filter_radius=2))


def study_of(places: Sequence[ir.Scene]) -> ir.Study:
    methods = [base.replace({"grid": grid, "grid.resolution": n}) for n in RESOLUTIONS for grid in GRIDS.values()]
    return ir.Study(
        name="do warps pay?", scenes=places, methods=methods, size=(320, 180), bounces=1,
        reference=ir.Reference(noise=5e-4, max_spp=512), repeats=2, max_repeats=2, images=False,
    )  # fmt: skip


def measure(folder: Path) -> pd.DataFrame:
    """A row per scene, resolution and warp: `error` (relMSE of indirect light) and `milliseconds`, `view` from inside or outside."""
    places = scenes()
    return table(ir.run(study_of(places), folder), places)


def table(records: ir.Records, places: Sequence[ir.Scene]) -> pd.DataFrame:
    inside = {place.name: INSIDE if _inside(place) else OUTSIDE for place in places}
    found = configurations(records)
    return pd.DataFrame(
        {
            "scene": found["scene"],
            "view": found["scene"].map(inside),
            "resolution": found["grid.resolution"].astype(int),
            "warp": found["grid.warp"].replace("Linear", EVEN),
            "error": found["indirect_relmse"],
            "milliseconds": found["milliseconds"],
        }
    )


def _inside(scene: ir.Scene) -> bool:
    low, high = np.asarray(scene.bounds)
    eye = np.asarray(next(iter(scene.cameras.values())).position)
    return bool(((eye > low) & (eye < high)).all())


def gains(found: pd.DataFrame, value: str = "error") -> pd.DataFrame:
    """`ratio` of each warp over even voxels of the same resolution; of "twice the resolution", even voxels over those half as fine."""
    warped = over(found, value, "warp", EVEN, ("scene", "view", "resolution"))
    even = found[found["warp"] == EVEN].set_index(["scene", "view", "resolution"])[value]
    finer = [
        {"scene": scene, "view": view, "resolution": n, "warp": "twice the resolution", "ratio": even[scene, view, 2 * n] / value_here}
        for (scene, view, n), value_here in even.items()
        if (scene, view, 2 * n) in even and value_here > 0 and even[scene, view, 2 * n] > 0
    ]
    return pd.concat([warped, pd.DataFrame(finer)], ignore_index=True)


def chart(found: pd.DataFrame) -> Figure:
    """A panel for views from inside and from outside at the middle resolution; left of 1 the warp errs less than even voxels."""
    middle = sorted(found["resolution"].unique())[len(found["resolution"].unique()) // 2]
    shown = gains(found)[lambda rows: rows["resolution"] == middle]
    panels = {
        f"{middle} voxels along the longest side, {view}": {
            str(name): list(group["ratio"]) for name, group in rows.groupby("warp", sort=False)
        }
        for view, rows in shown.groupby("view")
    }
    return strips(panels, "relMSE of indirect light, over even voxels' (dots: scenes)")


def told(found: pd.DataFrame) -> str:
    """The finding in words, with intervals over scenes."""
    errors, times = gains(found), gains(found, "milliseconds")
    lines = []
    for (view, n, warp), rows in errors.groupby(["view", "resolution", "warp"], sort=False):
        if len(rows) > 2:
            same = times[(times[["view", "resolution", "warp"]] == [view, n, warp]).all(axis=1)]["ratio"]
            error = ratio(list(rows["ratio"]))
            lines.append(f"{view}, {n}^3, {warp}: {error} of the error ({error.verdict}) for {ratio(list(same)).mean:.2f} of the time")
    return "\n".join(lines)
