"""A room behind a grille: depth edges, and pixels that neighbours cannot help."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, box, join, mesh, moved, quad, sphere
from interreflect.scenes.checks import number
from interreflect.scenes.values import Camera, DirectionalLight, EnvironmentLight, Material, Mesh, Scene

WIDTH, HEIGHT, DEPTH = 4.0, 2.6, 3.0  # metres
PLASTER = Material(name="plaster", albedo=(0.72, 0.7, 0.66))
FLOOR = Material(name="floor", albedo=(0.5, 0.34, 0.2))
IRON = Material(name="iron", albedo=(0.08, 0.08, 0.09))


@built_in
def grille(
    bars: Annotated[int, Knob("upright ones, over 4 metres", 2, 200)] = 24,
    width: Annotated[float, Knob("of a bar; also below 0.9 of the way from bar to bar", 0, 0.5, open_minimum=True, unit="m")] = 0.02,
) -> Scene:
    """A room open at its front (+z) behind a grille: upright bars, and lying ones that make squares; sun and sky.

    At 1280 x 720 a bar of 0.004 is about a pixel wide. Cameras "front" and, one step to the side, "beside".
    """
    spacing = WIDTH / bars
    number("grille.width", width, 0, min(0.5, 0.9 * spacing), open_low=True)
    meshes = [*_room(), *_furniture(), mesh(_grid(bars, spacing, width), IRON)]
    sun = DirectionalLight(direction=(0.45, -0.7, -0.75), irradiance=(16, 14.5, 12))
    sky = EnvironmentLight(radiance=(0.5, 0.65, 0.9))
    cameras = {
        "front": Camera(position=(-0.5, 1.5, 3.4), target=(0.1, 1.2, 0), fov_x=62),
        "beside": Camera(position=(-0.2, 1.5, 3.4), target=(0.4, 1.2, 0), fov_x=62),
    }
    return Scene(meshes=meshes, lights=[sun, sky], cameras=cameras)


def _room() -> list[Mesh]:
    """Five walls with thickness around x in [-2, 2], y in [0, 2.6], z in [-1.5, 1.5]."""
    x, y, z, skin = WIDTH / 2, HEIGHT, DEPTH / 2, 0.2
    back = box((-x - skin, -skin, -z - skin), (x + skin, y + skin, -z))
    left = box((-x - skin, -skin, -z - skin / 2), (-x, y + skin / 2, z))
    right = box((x, -skin, -z - skin / 2), (x + skin, y + skin / 2, z))
    ceiling = box((-x - skin / 2, y, -z - skin / 2), (x + skin / 2, y + skin, z))
    floor = box((-x - skin / 2, -skin, -z - skin / 2), (x + skin / 2, 0, z))
    return [mesh(join([back, ceiling]), PLASTER), mesh(floor, FLOOR), mesh(left, _paint("red")), mesh(right, _paint("blue"))]


def _paint(colour: str) -> Material:
    return Material(name=colour, albedo={"red": (0.6, 0.1, 0.07), "blue": (0.09, 0.18, 0.5)}[colour])


def _furniture() -> list[Mesh]:
    """Something for the bars to hide: a ball, a block and a picture on the wall."""
    yellow = Material(name="yellow", albedo=(0.7, 0.55, 0.1))
    block = moved(box((-0.35, 0, -0.35), (0.35, 0.9, 0.35)), (-0.8, 0, -0.5), turn=25)
    picture = quad((-0.2, 1.1, -1.49), (1.4, 0, 0), (0, 0.9, 0))
    ball = sphere(0.45, centre=(0.75, 0.45, -0.3), segments=32)
    return [mesh(ball, yellow), mesh(block, PLASTER), mesh(picture, _paint("blue"))]


def _grid(count: int, spacing: float, width: float) -> Shape:
    """Upright bars, and lying ones a little thinner so that no two faces coincide; their ends stand in the walls."""
    z, half = DEPTH / 2 - 0.1, width / 2
    across = (np.arange(count) + 0.5) * spacing - WIDTH / 2
    up = np.arange(0.5 * spacing, HEIGHT, spacing)
    upright = [box((x - half, -0.05, z - half), (x + half, HEIGHT + 0.05, z + half)) for x in across]
    thin = 0.8 * half
    lying = [box((-WIDTH / 2 - 0.05, y - half, z - thin), (WIDTH / 2 + 0.05, y + half, z + thin)) for y in up]
    return join([*upright, *lying])
