"""A bush of small leaves before a wall: many depths and normals in every tile of a picture."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, mesh, quad
from interreflect.scenes.values import Camera, DirectionalLight, EnvironmentLight, Mask, Material, Mesh, Scene

AREA = 2.5  # of all leaves, one side, m^2, whatever their length
SLENDER = 0.5  # width of a leaf over its length
HALF = (0.85, 0.6, 0.4)  # of the bush, an ellipsoid, m
CENTRE = (0.0, 0.75, 0.0)
LEAF = Material(name="leaf", albedo=(0.16, 0.4, 0.1), mask=Mask(np.hypot(*(np.mgrid[:32, :32] - 15.5)) < 16))


@built_in
def foliage(
    length: Annotated[float, Knob("of a leaf", 0.01, 0.4, unit="m")] = 0.06,
    seed: Annotated[int, Knob("of where leaves are and how they turn", 0, 2**31)] = 0,
) -> Scene:
    """Oval leaves, cut out by a mask, strewn over a bush 1.7 metres wide; a red wall behind and a floor, in sun and sky.

    Shorter leaves are more leaves: their area stays. At 1280 x 720 a leaf of 0.01 is 4 pixels long. Camera "front".
    """
    floor = quad((-2, 0, 1.6), (4, 0, 0), (0, 0, -2.6))
    wall = quad((-2, 0, -1), (4, 0, 0), (0, 2, 0))
    meshes = [
        mesh(floor, Material(name="floor", albedo=(0.6, 0.55, 0.5))),
        mesh(wall, Material(name="wall", albedo=(0.6, 0.2, 0.14))),
        _bush(length, np.random.default_rng(seed)),
    ]
    sun = DirectionalLight(direction=(-0.5, -0.8, -0.6), irradiance=(4, 3.7, 3.2))
    sky = EnvironmentLight(radiance=(0.25, 0.32, 0.45))
    camera = Camera(position=(0.25, 1.1, 2.6), target=(0, 0.75, 0), fov_x=46)
    return Scene(meshes=meshes, lights=[sun, sky], cameras={"front": camera})


def _bush(length: float, rng: np.random.Generator) -> Mesh:
    """Leaves with uniform places inside of the ellipsoid and uniform directions."""
    count = round(AREA / (np.pi / 4 * SLENDER * length**2))
    place = _directions(rng, count) * rng.uniform(size=(count, 1)) ** (1 / 3) * HALF + CENTRE
    along, other = _directions(rng, count), _directions(rng, count)
    across = np.cross(along, other)
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    u, v = along * (length / 2), across * (SLENDER * length / 2)
    corners = np.stack([place - u - v, place + u - v, place + u + v, place - u + v], 1)
    triangles = (4 * np.arange(count)[:, None, None] + [[0, 1, 2], [0, 2, 3]]).reshape(-1, 3).astype(np.uint32)
    texcoords = np.tile([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], (count, 1))
    return mesh(Shape(corners.reshape(-1, 3), triangles), LEAF, texcoords=texcoords)


def _directions(rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    """Uniform over the sphere, (count, 3)."""
    normal = rng.normal(size=(count, 3))
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))
