"""Where do voxels break? The value at which each failure crosses its tolerance, for every grid with the default filter, and for every
filter in the even grid: walls, sky, occlusion, bands, self-illumination, flicker, coarse shadow maps, layers that a march steps over.

Not a study of pictures but two atlases; every measured setting is kept, so it resumes. `python -m experiments.where_do_voxels_break`
prints the break points; `./run figures where_do_voxels_break` draws them too.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import interreflect as ir
from experiments.shared.atlases import Atlases, chart, measured, table
from experiments.shared.keep import FOLDER

__all__ = ["chart", "measure"]

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
    wanted = {"grids": grids, "filters": filters} if methods is None else methods
    return measured(folder, {name: (ways, failures) for name, ways in wanted.items()}, seeds, sweep, bisections)


if __name__ == "__main__":
    for title, one in measure(FOLDER / "where_do_voxels_break").items():
        print(f"{title}: where each failure crosses its tolerance\n{table(one).to_string()}\n")
