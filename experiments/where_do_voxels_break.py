"""Where do voxels break? The value at which each failure crosses its tolerance, for every grid with the default filter, and for every
filter in the even grid: walls, sky, occlusion, bands, self-illumination, flicker, coarse shadow maps, layers that a march steps over.

Not a study of pictures but two atlases; every measured setting is kept, so it resumes. `python -m experiments.where_do_voxels_break`
prints the break points; `./run figures where_do_voxels_break` draws them too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import FOLDER
from interreflect.charts.style import new_figure
from interreflect.stability.break_points import Cell
from interreflect.stability.crossing import ALWAYS, BREAKS, NEVER, REVERSED
from interreflect.stability.failure import Failure

RESOLUTION = 64
FAILURES = (
    "leak through a thin wall",
    "leak through a shifted wall",
    "leak through a turned wall",
    "leak through a wall at an angle",
    "leak through a wall off the grid",
    "sky through walls",
    "sky through turned walls",
    "occlusion by a ball",
    "occlusion by a wall",
    "banding",
    "self-illumination",
    "flicker under a dolly",
    "flicker under rotation",
    "shadow map coarser than the voxels",
    "opaque layer between empty ones",
    "opaque layer, opacity by the step's length",
)

# A pixel's cones are its own: what pixels share would flicker and band too, and hide the voxels. Cubes about the camera are twice as wide
# as the scene, lest they leave part of it out, and have as many more voxels, which are as small as the others.
base = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION), glossy=None, share=ir.EveryPixel())

grids = {
    name: base.replace(grid=grid)
    for name, grid in {
        "even": ir.Grid(resolution=RESOLUTION),
        "about the camera": ir.Grid(resolution=2 * RESOLUTION, region=ir.AroundCamera(width=2, step=1)),
        "not snapped": ir.Grid(resolution=2 * RESOLUTION, region=ir.AroundCamera(width=2, step=0)),
        "Logistic": ir.Grid(resolution=RESOLUTION, warp=ir.Logistic()),
        "CubicSpline": ir.Grid(resolution=RESOLUTION, warp=ir.CubicSpline()),
        "Perspective": ir.Grid(resolution=RESOLUTION, warp=ir.Perspective()),
        "Spherical": ir.Grid(resolution=RESOLUTION, warp=ir.Spherical()),
        "Spherical, not snapped": ir.Grid(resolution=RESOLUTION, warp=ir.Spherical(snap=False)),
        "nested, as fine": ir.Grid(resolution=RESOLUTION // 2, cascades=2),
        "nested, as many": ir.Grid(resolution=RESOLUTION, cascades=2),
    }.items()
}

filters = {
    name: base.replace({"prefilter": prefilter, **march})
    for name, prefilter, march in (
        ("VolumeCoverage", ir.VolumeCoverage(), {}),
        ("VolumeCoverage, tent", ir.VolumeCoverage(kernel="tent"), {}),
        ("SurfaceCoverage", ir.SurfaceCoverage(), {}),
        ("SurfaceCoverage, columns", ir.SurfaceCoverage(opacity="columns"), {}),
        ("SurfaceCoverage, as in the papers", ir.SurfaceCoverage(), {"march.opacity_correction": False, "march.density": 1.0}),
        ("Anisotropic", ir.Anisotropic(), {}),
        ("OctantCoverage", ir.OctantCoverage(), {}),
        ("OctantCoverage, columns", ir.OctantCoverage(opacity="columns"), {}),
        ("OctantCoverage, correlated", ir.OctantCoverage(), {"march.correlation": 1.0}),
        ("OctantCoverage, columns, correlated", ir.OctantCoverage(opacity="columns"), {"march.correlation": 1.0}),
        ("SphericalHarmonicVoxels", ir.SphericalHarmonicVoxels(), {}),
        ("SphericalHarmonicVoxels, columns", ir.SphericalHarmonicVoxels(opacity="columns"), {}),
    )
}

Atlases = Mapping[str, ir.stability.Atlas]


def measure(
    folder: Path,
    failures: Sequence[str] = FAILURES,
    methods: Mapping[str, Mapping[str, Any]] | None = None,
    seeds: Sequence[int] = (0,),
    sweep: int = 7,
    bisections: int = 2,
) -> Atlases:
    """Both atlases by name; break points as `break_points.csv` and pages of pictures in `folder`.

    One seed: lamps and suns make no noise, so that three seeds differ by .4 % at most in 95 of 100 settings.
    """
    rows = [row for row in ir.stability.failures if row.name in failures]
    wanted = {"grids": grids, "filters": filters} if methods is None else methods
    kept = folder / "settings"
    found = {name: ir.stability.atlas(ways, rows, seeds, sweep, bisections, kept) for name, ways in wanted.items()}
    for name, atlas in found.items():
        atlas.save(folder / f"{name}.html")
    pd.concat({name: atlas.break_points for name, atlas in found.items()}, names=["atlas"]).to_csv(folder / "break_points.csv")
    return found


def chart(atlases: Atlases) -> Figure:
    """A table for each atlas: break points in the failure's unit, shaded by how far along the sweep they lie."""
    heights = [len(atlas.failures) for atlas in atlases.values()]
    widest = max(len(atlas.methods) for atlas in atlases.values())
    figure = new_figure((3.4 + 1.0 * widest, 1.2 * len(heights) + 0.36 * sum(heights)), dark=False)
    for axes, (name, atlas) in zip(
        figure.subplots(len(atlases), 1, squeeze=False, height_ratios=heights).ravel(), atlases.items(), strict=True
    ):
        _draw(axes, name, atlas)
    return figure


def _draw(axes: Any, name: str, atlas: ir.stability.Atlas) -> None:
    held = [[_held(atlas.cell(method, failure)) for method in atlas.methods] for failure in atlas.failures]
    axes.imshow(held, cmap="RdYlGn", vmin=-0.3, vmax=1.3, aspect="auto")
    for y, failure in enumerate(atlas.failures):
        for x, method in enumerate(atlas.methods):
            axes.text(x, y, words(atlas.cell(method, failure)), ha="center", va="center", fontsize=7)
    axes.set_xticks(range(len(atlas.methods)), atlas.methods, fontsize=7, rotation=20, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(atlas.failures)), [_label(row) for row in atlas.failures.values()], fontsize=7)
    axes.set(xlabel=name, ylabel="failure and unit of its knob")
    axes.tick_params(length=0)


def _held(cell: Cell) -> float:
    """Share of the sweep, from the easy end, over which a method holds; what is above at the easy end holds nothing."""
    if cell.outcome == NEVER:
        return 1.0
    return cell.failure.share(cell.crossing.value) if cell.crossing is not None and cell.outcome == BREAKS else 0.0


def words(cell: Cell) -> str:
    """A break point in few characters; "from": the other way round, it holds beyond; *: it crosses more than once."""
    if cell.crossing is None or math.isnan(cell.crossing.value):
        return {NEVER: "never", ALWAYS: "always"}.get(cell.outcome, cell.outcome)
    number = f"{cell.crossing.value:.3g}" + ("*" if "crosses" in cell.crossing.words else "")
    return f"from {number}" if cell.outcome == REVERSED else number


def _label(row: Failure) -> str:
    unit = f", {row.unit}" if row.unit else ""
    return f"{row.name}{unit}\n{row.easy:.3g} to {row.hard:.3g}, tolerance {row.tolerance:g}"


def table(atlas: ir.stability.Atlas) -> pd.DataFrame:
    """Failures by methods: the break point in few characters."""
    return pd.DataFrame({method: {failure: words(atlas.cell(method, failure)) for failure in atlas.failures} for method in atlas.methods})


if __name__ == "__main__":
    for title, one in measure(FOLDER / "where_do_voxels_break").items():
        print(f"{title}: where each failure crosses its tolerance\n{table(one).to_string()}\n")
