"""A ball alone in the sun: a convex body lights nothing, itself included, so all indirect light is self-illumination."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import mesh, quad, sphere
from interreflect.scenes.values import Camera, DirectionalLight, Material, Scene


@built_in
def lone_ball(
    radius: Annotated[float, Knob("of the ball", 0, 0.3, open_minimum=True, unit="extents")] = 0.2,
    shift: Annotated[float, Knob("of the ball along all axes", 0, 0.05, unit="extents")] = 0.0,
) -> Scene:
    """A white ball above a black plate of side 1, lit by the sun. The truth of indirect light is 0.

    The plate keeps the bounds, so that a grid of n cells has voxels of 1 / n whatever the radius. Camera "front" sees the ball.
    """
    centre = (shift, 0.35 + shift, shift)
    plate = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    white, black = Material(name="ball", albedo=(0.8, 0.8, 0.8)), Material(name="plate", albedo=(0, 0, 0))
    sun = DirectionalLight(direction=(-0.6, -0.8, -0.5), irradiance=(3, 3, 3))
    camera = Camera(position=(shift, 0.35 + shift + radius, shift + 4 * radius), target=centre, fov_x=40, size=(512, 512))
    return Scene(meshes=[mesh(sphere(radius, centre=centre), white), mesh(plate, black)], lights=[sun], cameras={"front": camera})
