"""Rehfeld et al.'s scene as near as public files come: two cars in a court, Phong lobes everywhere, ten suns of a hemispherical sky."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from experiments.shared.placed import turned
from experiments.shared.scenes import load
from experiments.shared.suns import SUNS, sky

SIZE = (1742, 1145)  # the paper's pictures
DETAIL = 300_000  # triangles of the court: 1.85 M with two cars, the paper 1.9 M
EXPONENT = 50.0
LOBE = 0.2  # least specular reflectance, as a court and seats of diffuse materials have none
METRE = 4.9 / 10.0  # the car's file is 10.0 long, a BMW M6 4.9 m
PLACES = ((2.85, -1.3, 8.0), (2.45, 1.35, -10.0))  # x and z of a car's middle, m; degrees from facing +x
CAMERAS = {
    "cars": ir.Camera(position=(7.9, 1.55, -0.7), target=(2.6, 0.35, 0.0), fov_x=70, size=SIZE),
    "grille": ir.Camera(position=(6.4, 0.95, 0.1), target=(4.85, 0.6, 1.0), fov_x=52, size=SIZE),
}


@cache
def two_cars(exponent: float = EXPONENT, suns: int = SUNS) -> ir.Scene:
    """Bodies "car" and "car.1" on the floor of the atrium; cameras "cars" and "grille". FileNotFoundError where the car is not."""
    meshes = [*_court(exponent), *_car(exponent)]
    one = ir.Scene(meshes=meshes, lights=sky(suns), cameras=CAMERAS, bodies={"car": _pose(*PLACES[0])})
    name = f"two cars, exponent {exponent:g}, {suns} suns"
    return one.instance("car", [_pose(*PLACES[1])]).replace(name=name)


def _court(exponent: float) -> Iterator[ir.Mesh]:
    return (_glossy(mesh, exponent) for mesh in _atrium().meshes)


@cache
def _atrium() -> ir.Scene:
    return ir.scenes.atrium(DETAIL)


def _car(exponent: float) -> Iterator[ir.Mesh]:
    """Metres, the wheels' lowest point at y = 0."""
    file = load("bmw_m6/scene.toml")
    parts = [mesh for mesh in file.meshes if mesh.body == "car"]
    lowest = min(float(box[0][1]) for mesh in parts if (box := mesh.bounds(mesh.transform)) is not None)
    ground = np.diag([METRE, METRE, METRE, 1.0])
    ground[1, 3] = -METRE * lowest
    return (_glossy(mesh, exponent).replace(transform=ground @ mesh.transform) for mesh in parts)


def _glossy(mesh: ir.Mesh, exponent: float) -> ir.Mesh:
    specular = tuple(max(LOBE, value) for value in mesh.material.specular)
    return mesh.replace(material=mesh.material.replace(specular=specular, lobe="phong", exponent=exponent))


def _pose(x: float, z: float, degrees: float) -> NDArray[np.float64]:
    pose = np.eye(4)
    pose[:3, :3] = turned(180.0 + degrees)  # the file's car faces -x
    pose[:3, 3] = (x, 0.0, z)
    return pose
