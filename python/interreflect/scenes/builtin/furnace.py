"""The white furnace: a closed room whose walls all emit and reflect alike, so that its radiance is the same everywhere."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box, flipped, mesh, sphere
from interreflect.scenes.values import Camera, Material, Scene


@built_in
def furnace(
    shape: Annotated[str, Knob("around the origin: of side 2, or of radius 1", choices=("cube", "sphere"))] = "cube",
    albedo: Annotated[float, Knob("of all walls", 0, 0.999)] = 0.5,
    emission: Annotated[float, Knob("radiance of all walls", 0, unit="W/(m^2 sr)")] = 1.0,
) -> Scene:
    """A closed room whose radiance is emission / (1 - albedo) everywhere, emission (1 + albedo) after one reflection.

    One camera inside, "view".
    """
    walls = box((-1, -1, -1), (1, 1, 1)) if shape == "cube" else sphere()
    material = Material(name="wall", albedo=(albedo,) * 3, emission=(emission,) * 3)
    camera = Camera(position=(0.1, 0.05, -0.2), target=(0.6, 0.3, 0.5), fov_x=70, size=(512, 512))
    return Scene(meshes=[mesh(flipped(walls), material)], cameras={"view": camera})
