"""The integrating sphere: wherever light falls in, its reflection is spread evenly over the whole wall."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import flipped, mesh, sphere
from interreflect.scenes.values import Camera, Light, Material, PointLight, Scene, SpotLight


@built_in
def integrating_sphere(
    albedo: Annotated[float, Knob("of the wall", 0, 0.999)] = 0.5,
    radius: Annotated[float, Knob("of the sphere", 0, open_minimum=True)] = 1.0,
    flux: Annotated[float, Knob("of the light", 0, unit="W")] = 1.0,
    light: Annotated[str, Knob("at half the radius with a hard edge, or at the centre", choices=("spot", "point"))] = "spot",
    cap: Annotated[float, Knob("half angle of the spot", 0, 80, open_minimum=True, unit="degrees")] = 30.0,
) -> Scene:
    """A hollow sphere around the origin: light reflected once has the irradiance albedo flux / (4 pi radius^2) everywhere.

    Under the point light, direct light is even, too. One camera, "view", whose picture holds the spot's cap and dark wall.
    """
    r = radius
    wall = Material(name="wall", albedo=(albedo,) * 3)
    camera = Camera(position=(-0.5 * r, 0.2 * r, 0.1 * r), target=(r, 0, 0), fov_x=80, size=(512, 512))
    lights = [_point(flux) if light == "point" else _spot(flux, r, cap)]
    return Scene(meshes=[mesh(flipped(sphere(r)), wall)], lights=lights, cameras={"view": camera})


def _point(flux: float) -> Light:
    return PointLight(position=(0, 0, 0), intensity=(flux / (4 * np.pi),) * 3)


def _spot(flux: float, radius: float, half_angle: float) -> Light:
    intensity = flux / (2 * np.pi * (1 - np.cos(np.radians(half_angle))))
    place = (0, 0.5 * radius, -0.2 * radius)
    return SpotLight(position=place, direction=(1, -0.6, 0.3), intensity=(intensity,) * 3, inner=half_angle, outer=half_angle)
