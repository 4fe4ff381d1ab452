"""A floor below one layer of opaque voxels, empty ones above and below it, and the sun: does a march see the layer?"""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.values import Camera, DirectionalLight, Material, Mesh, Scene

FLOOR = 0.5  # half width


@built_in
def opaque_layer(cells: Annotated[int, Knob("along each side of the grid whose voxels lengths are given in", 16, 512)] = 64) -> Scene:
    """A sheet hides the sun from the floor below it, whose truth is 0; without the sheet its radiance would be 1.

    Across the picture of camera "below" the floor rises by two voxels, so that its rays to the sun meet the layer at every part of
    their steps. Camera "beside" sees that floor and the layer over it. A speck above keeps empty voxels over the layer: at the end of
    the domain a wall goes on for ever.
    """
    voxel = 2.0 / (cells - 1)
    below = Camera(position=(0.0, -2 * voxel, 0.0), target=(0.0, -12 * voxel, 0.0), up=(0.0, 0.0, -1.0), fov_x=60)
    beside = Camera(position=(-0.9, -6 * voxel, -0.4), target=(0.0, -6 * voxel, 0.1), fov_x=75, size=(640, 480))
    slope = 3 * voxel / FLOOR
    sun = DirectionalLight(direction=(0, -1, 0), irradiance=(2 * np.pi * float(np.hypot(1, slope)),) * 3)  # 2 pi at its angle
    speck = np.array([(0.95, 8 * voxel, 0.95), (0.96, 8 * voxel, 0.95), (0.95, 8 * voxel, 0.96)], np.float32)
    grey = Material(name="grey", albedo=(0.5, 0.5, 0.5))
    meshes = [
        _sheet(-12 * voxel, slope * FLOOR, FLOOR, grey),
        _sheet(0.25 * voxel, 0.0, 1.0, grey),
        Mesh(speck, np.array([[0, 2, 1]]), material=grey),
    ]
    return Scene(meshes=meshes, lights=[sun], cameras={"below": below, "beside": beside})


def _sheet(height: float, rise: float, half: float, material: Material) -> Mesh:
    """A square about the y axis that faces up; `rise` is how much higher it is at +x than in the middle."""
    corners = [(-half, height - rise, half), (half, height + rise, half), (half, height + rise, -half), (-half, height - rise, -half)]
    return Mesh(np.array(corners, np.float32), np.array([[0, 1, 2], [0, 2, 3]]), material=material)
