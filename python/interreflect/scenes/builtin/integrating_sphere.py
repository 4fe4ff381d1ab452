"""The integrating sphere: wherever light falls in, its reflection is spread evenly over the whole wall."""

from __future__ import annotations

import numpy as np

from interreflect.scenes.builtin.shapes import flipped, mesh, sphere
from interreflect.scenes.checks import choice, number
from interreflect.scenes.values import Camera, Light, Material, PointLight, Scene, SpotLight


def integrating_sphere(albedo: float = 0.5, radius: float = 1, flux: float = 1, light: str = "spot", cap: float = 30) -> Scene:
    """A hollow sphere around the origin: light reflected once has the irradiance albedo flux / (4 pi radius^2) everywhere.

    albedo: in [0, 0.999]. radius: above 0. flux: of the light, W, at least 0.
    light: "spot" (at half the radius, with a hard edge) or "point" (at the centre: direct light is even, too).
    cap: half angle of the spot, degrees, in (0, 80]. One camera, "view", whose picture holds the spot's cap and dark wall.
    ValueError names the knob, its bound and its value.
    """
    rho = number("integrating_sphere.albedo", albedo, 0, 0.999)
    r = number("integrating_sphere.radius", radius, 0, open_low=True)
    phi = number("integrating_sphere.flux", flux, 0)
    half_angle = number("integrating_sphere.cap", cap, 0, 80, open_low=True)
    choice("integrating_sphere.light", light, ("spot", "point"))
    wall = Material(name="wall", albedo=(rho,) * 3)
    camera = Camera(position=(-0.5 * r, 0.2 * r, 0.1 * r), target=(r, 0, 0), fov_x=80, size=(512, 512))
    name = f"integrating_sphere(albedo={rho:g}, radius={r:g}, flux={phi:g}, light={light!r}, cap={half_angle:g})"
    lights = [_point(phi) if light == "point" else _spot(phi, r, half_angle)]
    return Scene(name=name, meshes=[mesh(flipped(sphere(r)), wall)], lights=lights, cameras={"view": camera})


def _point(flux: float) -> Light:
    return PointLight(position=(0, 0, 0), intensity=(flux / (4 * np.pi),) * 3)


def _spot(flux: float, radius: float, half_angle: float) -> Light:
    intensity = flux / (2 * np.pi * (1 - np.cos(np.radians(half_angle))))
    place = (0, 0.5 * radius, -0.2 * radius)
    return SpotLight(position=place, direction=(1, -0.6, 0.3), intensity=(intensity,) * 3, inner=half_angle, outer=half_angle)
