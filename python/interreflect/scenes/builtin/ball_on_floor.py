"""A ball on a floor beside a lit wall: smooth indirect light over a curved and over a flat surface, where bands show."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, mesh, quad, sphere
from interreflect.scenes.values import Camera, Material, Mesh, Scene, SpotLight


@built_in
def ball_on_floor(radius: Annotated[float, Knob("of the ball, and with it all else", 0.005, 0.1, unit="extents")] = 0.1) -> Scene:
    """A smooth white ball on a white floor, a spot on the wall to the left: the ball and most of the floor are lit by the wall.

    Floor and wall are ten radii long; a black plate of side 1 below keeps the bounds, so that every radius makes the same picture
    from voxels of another size. Camera "front".
    """
    r = radius
    floor = quad((-5 * r, 0, 5 * r), (10 * r, 0, 0), (0, 0, -10 * r))
    wall = quad((-5 * r, 0, 5 * r), (0, 0, -10 * r), (0, 6 * r, 0))
    plate = quad((-0.5, -0.01, 0.5), (1, 0, 0), (0, 0, -1))
    white = Material(name="white", albedo=(0.75, 0.75, 0.75))
    strength = (300 * r * r,) * 3  # irradiance stays
    spot = SpotLight(position=(4.5 * r, 5 * r, 0), direction=(-1, -0.15, 0), intensity=strength, inner=12, outer=16)
    camera = Camera(position=(0, 2.2 * r, 4.5 * r), target=(0, 0.8 * r, 0), fov_x=45, size=(640, 480))
    meshes = [mesh(floor, white), mesh(wall, white), _ball(r), mesh(plate, Material(name="plate", albedo=(0, 0, 0)))]
    return Scene(meshes=meshes, lights=[spot], cameras={"front": camera})


def _ball(radius: float) -> Mesh:
    shape = sphere(radius)
    normals = shape.positions / np.linalg.norm(shape.positions, axis=1, keepdims=True)
    lifted = Shape(shape.positions + np.array((0.0, 1.001 * radius, 0.0)), shape.triangles)
    return mesh(lifted, Material(name="ball", albedo=(0.75, 0.75, 0.75)), normals=normals)
