"""A glowing disk above a floor: irradiance at a point, straight below or to the side."""

from __future__ import annotations

from interreflect.scenes.builtin.measured import point_camera
from interreflect.scenes.builtin.shapes import disk, mesh, quad
from interreflect.scenes.builtin.squares import emitter_material
from interreflect.scenes.checks import number
from interreflect.scenes.values import Camera, Material, Scene


def disk_above_point(radius: float = 1, height: float = 1, offset: float = 0, albedo: float = 0.5) -> Scene:
    """A black disk of exitance 1 that faces down at `height`, `offset` along x from the point at the origin of the floor y = 0.

    radius, height: above 0. offset: any. albedo: of the floor, in [0, 1].
    Camera "point" sees the surroundings of the origin, "view" floor and disk.
    ValueError names the knob, its bound and its value.
    """
    r = number("disk_above_point.radius", radius, 0, open_low=True)
    h = number("disk_above_point.height", height, 0, open_low=True)
    x = number("disk_above_point.offset", offset)
    rho = number("disk_above_point.albedo", albedo, 0, 1)
    side = 2 * (r + h + abs(x))
    floor = quad((-side, 0, side), (2 * side, 0, 0), (0, 0, -2 * side))
    cameras = {
        "point": point_camera((0, 0, 0), distance=0.5 * h),
        "view": Camera(position=(0.4 * side, 0.5 * h, 1.4 * side), target=(0, 0.3 * h, 0), fov_x=50, size=(512, 512)),
    }
    emitter = disk(r, centre=(x, h, 0), down=True)
    meshes = [mesh(floor, Material(name="floor", albedo=(rho,) * 3)), mesh(emitter, emitter_material())]
    name = f"disk_above_point(radius={r:g}, height={h:g}, offset={x:g}, albedo={rho:g})"
    return Scene(name=name, meshes=meshes, cameras=cameras)
