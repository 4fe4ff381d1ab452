"""Two walls lit in opposed colours with a grey floor between them: light that mixes to grey, and chrominance that must not shift."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import join, mesh, moved, quad, sphere
from interreflect.scenes.checks import Vector
from interreflect.scenes.values import Camera, Material, Scene, SpotLight


@built_in
def opposed_lights(
    saturation: Annotated[float, Knob("of the lights: 0 grey, 1 red against cyan", 0, 1)] = 1.0,
) -> Scene:
    """A spot on the left wall, a spot of the complementary colour on the right one; floor and ball are lit by these alone.

    Both lights together are grey. Camera "front".
    """
    floor = quad((-0.5, 0, 0.4), (1, 0, 0), (0, 0, -0.8))
    left = quad((-0.5, 0, 0.4), (0, 0, -0.8), (0, 0.6, 0))
    right = quad((0.5, 0, -0.4), (0, 0, 0.8), (0, 0.6, 0))
    grey = Material(name="grey", albedo=(0.7, 0.7, 0.7))
    low, high = 1.0 - saturation, 1.0 + saturation
    lights = [_spot(-1, (high, low, low)), _spot(1, (low, high, high))]
    ball = moved(sphere(0.1), (0, 0.11, 0))
    camera = Camera(position=(0, 0.4, 0.75), target=(0, 0.08, 0), fov_x=50, size=(640, 480))
    meshes = [mesh(join([floor, left, right]), grey), mesh(ball, Material(name="ball", albedo=(0.7, 0.7, 0.7)))]
    return Scene(meshes=meshes, lights=lights, cameras={"front": camera})


def _spot(side: int, intensity: Vector) -> SpotLight:
    return SpotLight(position=(-0.3 * side, 0.55, 0), direction=(side, -0.2, 0), intensity=intensity, inner=14, outer=20)
