"""A floor in the sun and a wall that the sun only grazes: all light of the wall comes from the floor, from all of it alike."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.values import Camera, DirectionalLight, Material, Scene

HEIGHT = 0.5  # of the wall


@built_in
def sunlit_floor(
    tilt: Annotated[float, Knob("of the sun from the vertical, along the wall", 0, 80, unit="degrees")] = 0.0,
) -> Scene:
    """A white floor of side 1 and a wall of half that height at one of its sides.

    Camera "view", above the floor, sees the wall and all of the floor but what is nearest.
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    wall = quad((-0.5, 0, 0.5), (0, 0, -1), (0, HEIGHT, 0))
    white = Material(name="white", albedo=(0.8, 0.8, 0.8))
    angle = np.radians(tilt)
    sun = DirectionalLight(direction=(0.0, -float(np.cos(angle)), -float(np.sin(angle))), irradiance=(3, 3, 3))
    camera = Camera(position=(0.45, 0.5, 0), target=(-0.5, -0.05, 0), fov_x=100, size=(640, 480))
    return Scene(meshes=[mesh(floor, white), mesh(wall, white)], lights=[sun], cameras={"view": camera})
