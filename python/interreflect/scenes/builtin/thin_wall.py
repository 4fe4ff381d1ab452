"""A closed dark box beside a lit room: what light shows up in the dark has leaked through the wall."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, box, flipped, join, mesh, moved, rotation_about_y, sphere
from interreflect.scenes.values import Camera, Material, PointLight, Scene

HULL = 0.4, 0.2, 0.36  # half length, half width and height of both rooms together
SKIN = 0.02  # of all walls but the one between the rooms


@built_in
def thin_wall(
    thickness: Annotated[float, Knob("of the wall between the rooms", 0, 0.2, open_minimum=True, unit="extents")] = 0.02,
    rotation: Annotated[float, Knob("of both rooms about the vertical", -180, 180, unit="degrees")] = 0.0,
    offset: Annotated[float, Knob("of the wall towards the dark room", -0.1, 0.1, unit="extents")] = 0.0,
    ball: Annotated[float, Knob("radius of a ball, its own body, hung in the dark room; 0: none", 0, 0.08, unit="extents")] = 0.0,
) -> Scene:
    """Two closed rooms with one wall between them, a point light in one. The truth of the dark room is 0.

    Lengths are in extents of the scene: a base plate keeps the longest side at 1 and the bounds the same for all knobs, so that
    a grid of n cells has voxels of 1 / n. Cameras "lit" and "dark" stand in the rooms, mirrored at the wall.
    """
    angle = rotation
    rooms = moved(_rooms(offset - thickness / 2, offset + thickness / 2), turn=angle)
    plate = box((-0.5, -SKIN, -0.5), (0.5, 0, 0.5))
    stone = Material(name="stone", albedo=(0.7, 0.7, 0.7))
    lamp = PointLight(position=_turned((-0.24, 0.27, 0.02), angle), intensity=(0.1, 0.09, 0.08))
    cameras = {name: _camera(side, angle) for name, side in (("lit", -1), ("dark", 1))}
    meshes = [mesh(rooms, stone), mesh(plate, stone)]
    if ball:
        place = _turned((offset + thickness / 2 + 0.1, 0.16, 0), angle)
        meshes.append(mesh(sphere(ball, centre=place, segments=24), Material(name="ball", albedo=(0.7, 0.7, 0.7)), body="ball"))
    return Scene(meshes=meshes, lights=[lamp], cameras=cameras)


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
