"""The Cornell box: two blocks in a white room with a red and a green wall, open to the viewer."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box as make_box
from interreflect.scenes.builtin.shapes import join, mesh, moved, quad, triple
from interreflect.scenes.values import Camera, Light, Material, Mesh, PointLight, Scene, SpotLight

WHITE = Material(name="white", albedo=(0.74, 0.74, 0.74))
# Reflectances in the spirit of the measured paints, linear sRGB.
RED = Material(name="red", albedo=(0.5, 0.05, 0.05))
GREEN = Material(name="green", albedo=(0.07, 0.4, 0.09))
BLOCKS = {
    "diffuse": Material(name="tall block", albedo=(0.74, 0.74, 0.74)),
    "glossy": Material(name="tall block", albedo=(0.12, 0.12, 0.12), specular=(0.65, 0.65, 0.65), roughness=0.35),
}
LIGHTS = ("area", "point", "spot")
LAMP = (16.0, 12.0, 6.5)  # radiance of the area light; the other two emit the same flux
LAMP_SIZE = (0.56, 0.44)


@built_in
def cornell_box(
    light: Annotated[str, Knob("below the ceiling; the spot lights the red wall and the floor", choices=LIGHTS)] = "area",
    box: Annotated[str, Knob("what the tall block is made of; glossy is a rough GGX lobe", choices=tuple(BLOCKS))] = "diffuse",
) -> Scene:
    """A room of 2 x 2 x 2 units on y = 0, open towards +z, with a tall and a short block. One camera, "front".

    All lights emit the same flux; under the spot most of the picture is indirect.
    """
    meshes = [*_room(), *_blocks(BLOCKS[box])]
    if light == "area":
        meshes.append(_lamp())
    camera = Camera(position=(0, 1, 3.9), target=(0, 1, 0), fov_x=39, size=(512, 512))
    return Scene(meshes=meshes, lights=_lights(light), cameras={"front": camera})


def _room() -> list[Mesh]:
    floor = quad((-1, 0, 1), (2, 0, 0), (0, 0, -2))
    ceiling = quad((-1, 2, -1), (2, 0, 0), (0, 0, 2))
    back = quad((-1, 0, -1), (2, 0, 0), (0, 2, 0))
    left = quad((-1, 0, 1), (0, 0, -2), (0, 2, 0))
    right = quad((1, 0, -1), (0, 0, 2), (0, 2, 0))
    return [mesh(join([floor, ceiling, back]), WHITE), mesh(left, RED), mesh(right, GREEN)]


def _blocks(tall: Material) -> list[Mesh]:
    unit = make_box((-0.3, 0, -0.3), (0.3, 0.6, 0.3))
    return [
        mesh(moved(unit, (-0.34, 0, -0.3), turn=17, scale=(1, 2, 1)), tall),
        mesh(moved(unit, (0.34, 0, 0.36), turn=-17), WHITE),
    ]


def _lamp() -> Mesh:
    width, depth = LAMP_SIZE
    panel = quad((-width / 2, 1.99, -depth / 2), (width, 0, 0), (0, 0, depth))
    return mesh(panel, Material(name="lamp", albedo=(0, 0, 0), emission=LAMP))


def _lights(kind: str) -> list[Light]:
    flux = np.pi * LAMP_SIZE[0] * LAMP_SIZE[1] * np.array(LAMP)
    if kind == "point":
        return [PointLight(position=(0, 1.75, 0), intensity=triple(flux / (4 * np.pi)))]
    if kind == "spot":
        inner, outer = 32.0, 40.0
        # The smoothstep of the cosine is 1/2 on average over its interval.
        solid_angle = np.pi * (2 - np.cos(np.radians(inner)) - np.cos(np.radians(outer)))
        intensity = triple(flux / solid_angle)
        place, aim = (0.55, 1.9, 0.3), (-0.75, -0.85, -0.2)
        return [SpotLight(position=place, direction=aim, intensity=intensity, inner=inner, outer=outer)]
    return []
