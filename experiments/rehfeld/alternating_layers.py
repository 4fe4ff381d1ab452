"""4: A step of half the cone's diameter resolves alternating opaque and empty voxels; a full diameter does not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import NONE
from experiments.shared.occlusion_picture import OcclusionPicture
from experiments.shared.panels import as_share, panels, picture

STEPS = (0.25, 0.5, 1.0)
RESOLUTION = 64
LAYERS = 1  # one opaque layer between empty ones: what lies behind must not be seen


def sheet(height: float, tilt: float, half: float = 1.0) -> ir.Mesh:
    """A square about the y axis, facing up; `tilt` is how much higher it is at +x than in the middle."""
    corners = [(-half, height - tilt, half), (half, height + tilt, half), (half, height + tilt, -half), (-half, height - tilt, -half)]
    return ir.Mesh(np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]]), material=ir.Material(albedo=(0.5, 0.5, 0.5)))


def layers() -> ir.Scene:
    """A floor below sheets one voxel thick, two voxels apart: opaque, empty, opaque. Across the picture the floor rises by three voxels, so
    that its cones meet the layers at every part of their steps. The sky above is what must stay hidden."""
    voxel = 2.0 / (RESOLUTION - 1)
    floor = sheet(-12 * voxel, 1.5 * voxel * 2.0, 0.5)  # over the middle half, which the camera sees: +- 1.5 voxels
    sheets = [sheet((0.25 + 2 * k) * voxel, 0.0) for k in range(LAYERS)]
    camera = ir.Camera(position=(0.0, -2 * voxel, 0.0), target=(0.0, -12 * voxel, 0.0), up=(0.0, 0.0, -1.0), fov_x=60)
    return ir.Scene(
        meshes=[floor, *sheets],
        lights=[ir.EnvironmentLight(radiance=(1.0, 1.0, 1.0))],
        cameras={"below": camera},
        name="alternating layers",
    )


def studies() -> Sequence[ir.Study]:
    """One layer; cones that are still no wider than a voxel when they meet it, so that the finest level is what they sample."""
    cones = ir.DiffuseCones(cones=3, half_angle=2.0, normal_offset=1.5, first_diameter=1.0, level_bias=0.0, density=1.0)
    ways = [
        OcclusionPicture(grid=ir.Grid(resolution=RESOLUTION), prefilter=ir.SurfaceCoverage(), march=cones.replace(step=step))
        for step in STEPS
    ]
    return [
        ir.Study(name="Rehfeld: alternating layers", scenes=[layers()], methods=ways, size=(160, 90), bounces=0, reference=NONE, repeats=0)
    ]


def openness(records: ir.Records) -> dict[float, tuple[float, float, float]]:
    """Step -> mean, least and most of what cones leave open below the layer, over the picture. Right: 0 everywhere."""
    found = {}
    for i, step in enumerate(STEPS):
        shown = picture(records, i)[..., 0]
        found[step] = (float(shown.mean()), float(shown.min()), float(shown.max()))
    return found


def chart(records: ir.Records) -> Figure:
    told = openness(records)
    shown = [
        (f"step of {step:g} diameters\nopen: {mean:.1%} ({least:.1%} to {most:.1%})", as_share(picture(records, i)))
        for i, (step, (mean, least, most)) in enumerate(told.items())
    ]
    return panels(shown, columns=3, title="what cones leave open below one opaque layer of voxels (right: nothing)")
