"""Pairs of unit squares of which one lights the other: facing each other, or as the two sides of a corner."""

from __future__ import annotations

import numpy as np

from interreflect.scenes.builtin.measured import facing_camera
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.checks import choice, number
from interreflect.scenes.values import Camera, Light, Material, Mesh, Scene, SpotLight

FLOOR = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))


def emitter_material() -> Material:
    """Black, of exitance 1."""
    return Material(name="emitter", albedo=(0, 0, 0), emission=(1 / np.pi,) * 3)


def facing_squares(distance: float = 1, albedo: float = 0.5) -> Scene:
    """A unit square at y = `distance` of exitance 1 that faces a reflecting unit square on y = 0.

    distance: above 0. albedo: of the lower square, in [0, 1].
    Camera "receiver" sees exactly the lower square, every part of it alike; "view" sees both.
    ValueError names the knob, its bound and its value.
    """
    d = number("facing_squares.distance", distance, 0, open_low=True)
    rho = number("facing_squares.albedo", albedo, 0, 1)
    emitter = quad((-0.5, d, -0.5), (1, 0, 0), (0, 0, 1))
    cameras = {
        "receiver": facing_camera((0, 0, 0), (0, 1, 0), half_width=0.5, distance=0.5 * d),
        "view": Camera(position=(1.2, 0.3 * d, 1.8), target=(0, 0.4 * d, 0), fov_x=60, size=(512, 512)),
    }
    meshes = [_receiver(rho), mesh(emitter, emitter_material())]
    return Scene(name=f"facing_squares(distance={d:g}, albedo={rho:g})", meshes=meshes, cameras=cameras)


def corner(light: str = "wall", albedo: float = 0.5) -> Scene:
    """A floor and a wall, unit squares with a shared edge: where virtual point lights are singular.

    light: "wall" (the wall is black and has exitance 1) or "spot" (the wall reflects, too, and a spot lights its middle).
    albedo: of what reflects, in [0, 1].
    Camera "receiver" sees exactly the floor, every part of it alike; "view" sees both.
    ValueError names the knob, its bound and its value.
    """
    choice("corner.light", light, ("wall", "spot"))
    rho = number("corner.albedo", albedo, 0, 1)
    wall = quad((-0.5, 0, 0.5), (0, 0, -1), (0, 1, 0))
    material = emitter_material() if light == "wall" else Material(name="wall", albedo=(rho,) * 3)
    cameras = {
        "receiver": facing_camera((0, 0, 0), (0, 1, 0), half_width=0.5, distance=0.5),
        "view": Camera(position=(1.3, 0.8, 1.2), target=(-0.2, 0.35, 0), fov_x=50, size=(512, 512)),
    }
    lights = [_spot()] if light == "spot" else []
    name = f"corner(light={light!r}, albedo={rho:g})"
    return Scene(name=name, meshes=[_receiver(rho), mesh(wall, material)], lights=lights, cameras=cameras)


def _receiver(albedo: float) -> Mesh:
    return mesh(FLOOR, Material(name="receiver", albedo=(albedo,) * 3))


def _spot() -> Light:
    return SpotLight(position=(1, 0.6, 0), direction=(-1, -0.1, 0), intensity=(4, 4, 4), inner=12, outer=14)
