"""A closed room under a white sky: what light shows up inside has come through its walls."""

from __future__ import annotations

from typing import Annotated

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import box, flipped, join, mesh, moved, rotation_about_y, triple
from interreflect.scenes.values import Camera, EnvironmentLight, Material, Scene

ALBEDO = 0.7
HALF, LOW, HIGH = 0.2, 0.15, 0.4  # half width and heights of the room inside
EYE, TARGET = (0.13, 0.32, 0.13), (-0.1, 0.22, -0.1)


@built_in
def dark_room(
    thickness: Annotated[float, Knob("of floor, walls and ceiling", 0, 0.13, open_minimum=True, unit="extents")] = 0.05,
    rotation: Annotated[float, Knob("of the room about the vertical", -180, 180, unit="degrees")] = 0.0,
    offset: Annotated[float, Knob("of the room along all axes", 0, 0.02, unit="extents")] = 0.0,
) -> Scene:
    """One closed room under a sky of radiance 1. The truth inside is 0.

    Lengths are in extents of the scene: a base plate keeps the longest side at 1 for all knobs, so that a grid of n cells has voxels
    of 1 / n. Camera "dark" stands in the room.
    """
    t = thickness
    hull = box((-HALF - t, LOW - t, -HALF - t), (HALF + t, HIGH + t, HALF + t))
    room = join([hull, flipped(box((-HALF, LOW, -HALF), (HALF, HIGH, HALF)))])
    plate = box((-0.5, -0.02, -0.5), (0.5, 0, 0.5))
    stone = Material(name="stone", albedo=(ALBEDO,) * 3)
    turned = rotation_about_y(rotation)
    eye, target = (triple(turned @ p + offset) for p in (EYE, TARGET))
    meshes = [mesh(moved(room, (offset,) * 3, turn=rotation), stone), mesh(plate, stone)]
    camera = Camera(position=eye, target=target, fov_x=80, size=(512, 512))
    return Scene(meshes=meshes, lights=[EnvironmentLight()], cameras={"dark": camera})
