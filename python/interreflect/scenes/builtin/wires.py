"""Wires in the air before the sky: surfaces a pixel wide whose neighbours lie at other depths or nowhere."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import join, mesh, quad, tube
from interreflect.scenes.values import Camera, DirectionalLight, Material, Scene

CORNERS = 6  # of a wire's cross-section


@built_in
def wires(
    width: Annotated[float, Knob("of a wire", 0.001, 0.2, unit="m")] = 0.01,
    count: Annotated[int, Knob("of them", 1, 1000)] = 40,
    seed: Annotated[int, Knob("of where they run", 0, 2**31)] = 0,
) -> Scene:
    """White wires across one another at depths of 1.5 to 5 metres, lit from below by a sunlit floor that the camera does not see.

    Behind them is black sky. At 1280 x 720 a wire of 0.004 is between 2 pixels and half of one wide. Camera "front".
    """
    rng = np.random.default_rng(seed)
    floor = mesh(quad((-4, 0, 4), (8, 0, 0), (0, 0, -8)), Material(name="floor", albedo=(0.7, 0.6, 0.45)))
    made = []
    for z in rng.uniform(-3, 0.5, count):
        left, right = rng.uniform(0.5, 4.5, 2)
        made.append(tube((-3.5, left, z), (3.5, right, z + rng.uniform(-0.3, 0.3)), width / 2, CORNERS))
    white = Material(name="wire", albedo=(0.7, 0.7, 0.7))
    sun = DirectionalLight(direction=(0.3, -0.9, -0.3), irradiance=(10, 9.5, 9))
    camera = Camera(position=(0, 1.2, 2.0), target=(0, 2.3, -0.5), fov_x=40)
    return Scene(meshes=[floor, mesh(join(made), white)], lights=[sun], cameras={"front": camera})
