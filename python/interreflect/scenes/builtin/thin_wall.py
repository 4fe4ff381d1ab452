"""A closed dark box beside a lit room: what light shows up in the dark has leaked through the wall."""

from __future__ import annotations

from interreflect.scenes.builtin.shapes import Shape, box, flipped, join, mesh, moved, rotation_about_y
from interreflect.scenes.checks import number
from interreflect.scenes.values import Camera, Material, PointLight, Scene

HULL = 0.4, 0.2, 0.36  # half length, half width and height of both rooms together
SKIN = 0.02  # of all walls but the one between the rooms


def thin_wall(thickness: float = 0.02, rotation: float = 0, offset: float = 0) -> Scene:
    """Two closed rooms with one wall between them, a point light in one. The truth of the dark room is 0.

    Lengths are in extents of the scene: a base plate keeps the longest side at 1 and the bounds the same for all knobs, so that
    a grid of n cells has voxels of 1 / n.
    thickness: of the wall, in (0, 0.2]. rotation: of the rooms about the vertical, degrees, in [-180, 180].
    offset: of the wall towards the dark room, in [-0.1, 0.1].
    Cameras "lit" and "dark" stand in the rooms, mirrored at the wall. ValueError names the knob, its bound and its value.
    """
    t = number("thin_wall.thickness", thickness, 0, 0.2, open_low=True)
    angle = number("thin_wall.rotation", rotation, -180, 180)
    shift = number("thin_wall.offset", offset, -0.1, 0.1)
    rooms = moved(_rooms(shift - t / 2, shift + t / 2), turn=angle)
    plate = box((-0.5, -SKIN, -0.5), (0.5, 0, 0.5))
    stone = Material(name="stone", albedo=(0.7, 0.7, 0.7))
    lamp = PointLight(position=_turned((-0.24, 0.27, 0.02), angle), intensity=(0.1, 0.09, 0.08))
    cameras = {name: _camera(side, angle) for name, side in (("lit", -1), ("dark", 1))}
    name = f"thin_wall(thickness={t:g}, rotation={angle:g}, offset={shift:g})"
    return Scene(name=name, meshes=[mesh(rooms, stone), mesh(plate, stone)], lights=[lamp], cameras=cameras)


def _rooms(wall_begin: float, wall_end: float) -> Shape:
    length, width, height = HULL
    hull = box((-length, -SKIN / 2, -width), (length, height, width))
    low, high, side = SKIN, height - SKIN, width - SKIN
    lit = box((-length + SKIN, low, -side), (wall_begin, high, side))
    dark = box((wall_end, low, -side), (length - SKIN, high, side))
    return join([hull, flipped(lit), flipped(dark)])


def _turned(point: tuple[float, float, float], angle: float) -> tuple[float, float, float]:
    x, y, z = rotation_about_y(angle) @ point
    return float(x), float(y), float(z)


def _camera(side: int, angle: float) -> Camera:
    eye, target = (side * 0.36, 0.24, 0.15), (side * 0.1, 0.12, -0.05)
    return Camera(position=_turned(eye, angle), target=_turned(target, angle), fov_x=80, size=(512, 512))
