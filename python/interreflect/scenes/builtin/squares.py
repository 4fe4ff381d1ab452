"""Pairs of unit squares of which one lights the other: facing each other, or as the two sides of a corner."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.patterns import encoded
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.values import Camera, DirectionalLight, Light, Material, Mesh, Scene, SpotLight, Texture

FLOOR = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))


def emitter_material() -> Material:
    """Black, of exitance 1."""
    return Material(name="emitter", albedo=(0, 0, 0), emission=(1 / np.pi,) * 3)


@built_in
def facing_squares(
    distance: Annotated[float, Knob("between the squares", 0, open_minimum=True)] = 1.0,
    albedo: Annotated[float, Knob("of the lower square", 0, 1)] = 0.5,
) -> Scene:
    """A black unit square of exitance 1 at y = `distance`, facing a reflecting unit square on y = 0.

    Camera "receiver" sees exactly the lower square, every part of it alike; "view" sees both.
    """
    d = distance
    emitter = quad((-0.5, d, -0.5), (1, 0, 0), (0, 0, 1))
    cameras = {
        "receiver": facing_camera((0, 0, 0), (0, 1, 0), half_width=0.5, distance=0.5 * d),
        "view": Camera(position=(1.2, 0.3 * d, 1.8), target=(0, 0.4 * d, 0), fov_x=60, size=(512, 512)),
    }
    meshes = [_receiver(albedo), mesh(emitter, emitter_material())]
    return Scene(meshes=meshes, cameras=cameras)


@built_in
def corner(
    light: Annotated[str, Knob("the wall (black, of exitance 1), or what lights it", choices=("wall", "spot", "sun"))] = "wall",
    albedo: Annotated[float, Knob("of what reflects", 0, 1)] = 0.5,
    aim: Annotated[float, Knob("height at which the spot's axis meets the wall", 0, 1)] = 0.45,
    cap: Annotated[float, Knob("half angle of the spot", 1, 40, unit="degrees")] = 14.0,
    fields: Annotated[int, Knob("chequers along a side of the wall; 0: plain", 0, 64)] = 0,
) -> Scene:
    """A floor and a wall, unit squares with a shared edge: where virtual point lights are singular.

    Camera "receiver" sees exactly the floor, every part of it alike; "view" sees both. The spot stands .1 to .6 above the floor,
    level with its aim or above it. The sun shines along the floor and gives the wall an irradiance of 2.
    """
    wall = quad((-0.5, 0, 0.5), (0, 0, -1), (0, 1, 0))
    material = emitter_material() if light == "wall" else Material(name="wall", albedo=(albedo,) * 3)
    cameras = {
        "receiver": facing_camera((0, 0, 0), (0, 1, 0), half_width=0.5, distance=0.5),
        "view": Camera(position=(1.3, 0.8, 1.2), target=(-0.2, 0.35, 0), fov_x=50, size=(512, 512)),
    }
    if fields and light != "wall":
        material = material.replace(albedo_map=Texture(encoded(_chequers(fields, albedo))), albedo=(1, 1, 1))
    along_the_floor = DirectionalLight(direction=(-1, 0, 0), irradiance=(2, 2, 2))
    lights: dict[str, list[Light]] = {"wall": [], "spot": [_spot(aim, cap)], "sun": [along_the_floor]}
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    return Scene(meshes=[_receiver(albedo), mesh(wall, material, texcoords=corners)], lights=lights[light], cameras=cameras)


def _receiver(albedo: float) -> Mesh:
    return mesh(FLOOR, Material(name="receiver", albedo=(albedo,) * 3))


def _spot(aim: float, cap: float) -> Light:
    place = (1.0, max(0.1, min(aim + 0.15, 0.6)), 0.0)
    direction = (-1.5, aim - place[1], 0.0)
    return SpotLight(position=place, direction=direction, intensity=(4, 4, 4), inner=cap * 6 / 7, outer=cap)


def _chequers(fields: int, albedo: float) -> NDArray[np.float64]:
    """(256, 256, 3) reflectance: white fields of `albedo`, black ones of a tenth of it."""
    place = np.arange(256) * fields // 256
    white = (place[:, None] + place) % 2 == 0
    return np.repeat(np.where(white, albedo, albedo / 10)[..., None], 3, axis=2)
