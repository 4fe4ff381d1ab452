"""A glossy floor before a wall with a small bright patch: a sharp feature in a lobe, where few harmonics ring."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import mesh, quad
from interreflect.scenes.values import Camera, Material, Scene, SpotLight


@built_in
def glossy_receiver(
    spot: Annotated[float, Knob("half angle of the spot on the wall", 1, 40, unit="degrees")] = 10.0,
    exponent: Annotated[float, Knob("of the floor's Phong lobe", 1, 1000)] = 50.0,
) -> Scene:
    """A dark floor of side 1 with a Phong lobe mirrors a spot of light on a white wall into the camera "front".

    The spot's flux does not depend on its width. Without a ceiling or sides, indirect light comes from the wall alone.
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    wall = quad((-0.5, 0, -0.5), (1, 0, 0), (0, 0.8, 0))
    shiny = Material(name="floor", albedo=(0.1,) * 3, specular=(0.6,) * 3, lobe="phong", exponent=exponent)
    strength = 2.0 * (10.0 / spot) ** 2
    light = SpotLight(position=(0, 0.75, 0.4), direction=(0, -0.35, -0.9), intensity=(strength,) * 3, inner=0.9 * spot, outer=spot)
    camera = Camera(position=(0.1, 0.35, 0.75), target=(0, 0.1, -0.2), fov_x=50, size=(640, 480))
    meshes = [mesh(floor, shiny), mesh(wall, Material(name="wall", albedo=(0.75,) * 3))]
    return Scene(meshes=meshes, lights=[light], cameras={"front": camera})
