"""A glowing disk above a floor: irradiance at a point, straight below or to the side."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.measured import point_camera
from interreflect.scenes.builtin.shapes import disk, mesh, quad
from interreflect.scenes.builtin.squares import emitter_material
from interreflect.scenes.values import Camera, Material, Scene


@built_in
def disk_above_point(
    radius: Annotated[float, Knob("of the disk", 0, open_minimum=True)] = 1.0,
    height: Annotated[float, Knob("of the disk above the floor", 0, open_minimum=True)] = 1.0,
    offset: Annotated[float, Knob("of the disk's centre along x")] = 0.0,
    albedo: Annotated[float, Knob("of the floor", 0, 1)] = 0.5,
) -> Scene:
    """A black disk of exitance 1 that faces down on the floor y = 0, and the point of the floor at the origin.

    Camera "point" sees the surroundings of the origin, "view" floor and disk.
    """
    r, h, x = radius, height, offset
    side = 2 * (r + h + abs(x))
    floor = quad((-side, 0, side), (2 * side, 0, 0), (0, 0, -2 * side))
    cameras = {
        "point": point_camera((0, 0, 0), distance=0.5 * h),
        "view": Camera(position=(0.4 * side, 0.5 * h, 1.4 * side), target=(0, 0.3 * h, 0), fov_x=50, size=(512, 512)),
    }
    emitter = disk(r, centre=(x, h, 0), down=True)
    meshes = [mesh(floor, Material(name="floor", albedo=(albedo,) * 3)), mesh(emitter, emitter_material())]
    return Scene(meshes=meshes, cameras=cameras)
