"""A box sunk into a floor: texels and voxels that lie half inside it, and the seams where light stored in them steps."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box, mesh, moved, quad
from interreflect.scenes.values import Camera, Material, Scene, SpotLight


@built_in
def sunk_box(
    depth: Annotated[float, Knob("how far the box reaches below the floor", 0, 0.2, open_minimum=True, unit="extents")] = 0.02,
    height: Annotated[float, Knob("of the box above the floor", 0, 0.3, open_minimum=True, unit="extents")] = 0.15,
) -> Scene:
    """A closed box, turned by 20 degrees, stands through a floor of side 1 beside a wall that a spot lights.

    The part below the floor is lit by nothing. Camera "front" sees the seam between box and floor.
    """
    floor = quad((-0.5, 0, 0.5), (1, 0, 0), (0, 0, -1))
    wall = quad((-0.5, 0, 0.5), (0, 0, -1), (0, 0.7, 0))
    body = moved(box((-0.12, -depth, -0.12), (0.12, height, 0.12)), (0.02, 0, 0.03), turn=20)
    white = Material(name="white", albedo=(0.75,) * 3)
    light = SpotLight(position=(0.4, 0.55, 0), direction=(-1, -0.2, 0), intensity=(3, 3, 3), inner=14, outer=20)
    camera = Camera(position=(-0.2, 0.4, 0.6), target=(0, 0.03, 0.03), fov_x=45, size=(640, 480))
    meshes = [mesh(floor, white), mesh(wall, white), mesh(body, Material(name="box", albedo=(0.6, 0.6, 0.6)))]
    return Scene(meshes=meshes, lights=[light], cameras={"front": camera})
