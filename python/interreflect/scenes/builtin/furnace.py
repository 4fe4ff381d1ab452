"""The white furnace: a closed room whose walls all emit and reflect alike, so that its radiance is the same everywhere."""

from __future__ import annotations

from interreflect.scenes.builtin.shapes import box, flipped, mesh, sphere
from interreflect.scenes.checks import choice, number
from interreflect.scenes.values import Camera, Material, Scene


def furnace(shape: str = "cube", albedo: float = 0.5, emission: float = 1) -> Scene:
    """A closed room whose radiance is emission / (1 - albedo) everywhere, emission (1 + albedo) after one reflection.

    shape: "cube" (side 2) or "sphere" (radius 1), around the origin. One camera inside, "view".
    albedo: of all walls, in [0, 0.999]. emission: radiance of all walls, at least 0.
    ValueError names the knob, its bound and its value.
    """
    choice("furnace.shape", shape, ("cube", "sphere"))
    rho = number("furnace.albedo", albedo, 0, 0.999)
    radiance = number("furnace.emission", emission, 0)
    walls = box((-1, -1, -1), (1, 1, 1)) if shape == "cube" else sphere()
    material = Material(name="wall", albedo=(rho,) * 3, emission=(radiance,) * 3)
    camera = Camera(position=(0.1, 0.05, -0.2), target=(0.6, 0.3, 0.5), fov_x=70, size=(512, 512))
    name = f"furnace(shape={shape!r}, albedo={rho:g}, emission={radiance:g})"
    return Scene(name=name, meshes=[mesh(flipped(walls), material)], cameras={"view": camera})
