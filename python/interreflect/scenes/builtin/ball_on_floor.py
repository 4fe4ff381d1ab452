"""A ball on a floor beside a lit wall: smooth indirect light over a curved and over a flat surface, where bands show."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, mesh, quad, sphere
from interreflect.scenes.values import Camera, Material, Mesh, Scene, SpotLight


@built_in
def ball_on_floor(radius: Annotated[float, Knob("of the ball", 0.005, 0.2, unit="extents")] = 0.1) -> Scene:
    """A smooth white ball on a white floor of side 1, a spot on the wall to the left: all that the camera sees is lit by the wall.

    Camera "front" is as far from the ball as this is wide, so that every radius makes the same picture of it.
    """
    r = radius
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    wall = quad((-0.5, 0, 0.5), (0, 0, -1), (0, 0.6, 0))
    white = Material(name="white", albedo=(0.75, 0.75, 0.75))
    spot = SpotLight(position=(0.45, 0.5, 0), direction=(-1, -0.15, 0), intensity=(3, 3, 3), inner=12, outer=16)
    camera = Camera(position=(0, 2.2 * r, 4.5 * r), target=(0, 0.8 * r, 0), fov_x=45, size=(640, 480))
    return Scene(meshes=[mesh(floor, white), mesh(wall, white), _ball(r)], lights=[spot], cameras={"front": camera})


def _ball(radius: float) -> Mesh:
    shape = sphere(radius)
    normals = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    lifted = Shape(shape.positions + np.array((0.0, 1.001 * radius, 0.0)), shape.triangles)
    return mesh(lifted, Material(name="ball", albedo=(0.75, 0.75, 0.75)), normals=normals)
