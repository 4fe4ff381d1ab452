"""A ball against the sky: a picture of which most tiles show no surface."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import mesh, quad, sphere
from interreflect.scenes.values import Camera, DirectionalLight, Material, Scene


@built_in
def ball_in_sky(radius: Annotated[float, Knob("of the ball", 0.005, 0.3, unit="extents")] = 0.1) -> Scene:
    """A white ball over a sunlit floor of side 1, seen from the floor upwards: its underside, lit by the floor alone, and black sky.

    The picture is 1.1 extents wide where the ball is. Camera "front".
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    ball = sphere(radius, centre=(0, 0.5, 0), segments=32)
    sun = DirectionalLight(direction=(-0.3, -0.9, 0.1), irradiance=(5, 5, 5))
    camera = Camera(position=(0.1, 0.02, 0.3), target=(0, 0.5, 0), fov_x=90)
    meshes = [mesh(floor, Material(name="floor", albedo=(0.7, 0.5, 0.3))), mesh(ball, Material(name="ball", albedo=(0.75, 0.75, 0.75)))]
    return Scene(meshes=meshes, lights=[sun], cameras={"front": camera})
