"""A closed box under a ceiling whose light has a pattern: four asterisks and a ring."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, box, flipped, grid_triangles, join, mesh, quad, rotation_about_y, sphere
from interreflect.scenes.values import Camera, Material, Mesh, Scene, Texture

WHITE = Material(name="white", albedo=(0.75, 0.75, 0.75))
SIZE = 256  # texels along a side of the emission map


@built_in
def textured_light_box(
    radiance: Annotated[float, Knob("of the pattern's lit texels", 0, unit="W/(m^2 sr)")] = 12.0,
    grating: Annotated[int, Knob("bars each way of a grid below the ceiling that lights the bodies in stripes", 0, 64)] = 0,
) -> Scene:
    """A white box of 2 x 2 x 2 units on y = 0 whose whole ceiling emits through a map, and two bodies of their own in it.

    Stands in for the box of figure 7 in Jendersie et al., where the bodies, "ball" and "torus", take their light from a grid of
    caches and the walls from light maps. Camera "front".
    """
    meshes = [*_room(), _ceiling(radiance), *_bodies()]
    if grating:
        meshes.append(mesh(_grating(grating), Material(name="grating", albedo=(0.3, 0.3, 0.3))))
    camera = Camera(position=(0.12, 0.95, 0.98), target=(-0.04, 0.92, -1), fov_x=96, size=(512, 512))
    return Scene(meshes=meshes, cameras={"front": camera})


def _room() -> list[Mesh]:
    floor = quad((-1, 0, 1), (2, 0, 0), (0, 0, -2))
    walls = [quad((-1, 0, -1), (2, 0, 0), (0, 2, 0)), quad((1, 0, 1), (-2, 0, 0), (0, 2, 0))]
    left, right = quad((-1, 0, 1), (0, 0, -2), (0, 2, 0)), quad((1, 0, -1), (0, 0, 2), (0, 2, 0))
    return [
        mesh(join([floor, *walls]), WHITE),
        mesh(left, Material(name="orange", albedo=(0.7, 0.32, 0.08))),
        mesh(right, Material(name="blue", albedo=(0.1, 0.3, 0.65))),
    ]


def _ceiling(strength: float) -> Mesh:
    panel = quad((-1, 2, -1), (2, 0, 0), (0, 0, 2))
    texcoords = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    pattern = Texture(np.repeat(emission_pattern()[..., None], 3, axis=2))
    emission = (strength, 0.93 * strength, 0.8 * strength)
    glow = Material(name="ceiling", albedo=(0.75, 0.75, 0.75), emission=emission, emission_map=pattern)
    return mesh(panel, glow, texcoords=texcoords)


def emission_pattern() -> NDArray[np.float32]:
    """(SIZE, SIZE) from 0 to 1: asterisks of three strokes in the corners, a ring in the middle; edges are one texel soft."""
    axis = (np.arange(SIZE) + 0.5) / SIZE * 2 - 1
    x, y = np.meshgrid(axis, -axis)
    distance = np.abs(np.hypot(x, y) - 0.3) - 0.05
    for cx in (-0.6, 0.6):
        for cy in (-0.6, 0.6):
            for angle in np.radians((0, 60, 120)):
                along = (x - cx) * np.cos(angle) + (y - cy) * np.sin(angle)
                across = -(x - cx) * np.sin(angle) + (y - cy) * np.cos(angle)
                distance = np.minimum(distance, np.maximum(np.abs(along) - 0.24, np.abs(across) - 0.035))
    return np.clip(0.5 - distance * SIZE / 2, 0, 1).astype(np.float32)


def _bodies() -> list[Mesh]:
    ball = sphere(0.28, centre=(-0.42, 0.28, -0.05), segments=48)
    normals = (ball.positions - (-0.42, 0.28, -0.05)) / 0.28
    white = Material(name="ball", albedo=(0.7, 0.7, 0.7))
    return [mesh(ball, white, normals=normals, body="ball"), _torus(Material(name="torus", albedo=(0.72, 0.68, 0.5)))]


def _torus(material: Material, around: int = 64, tube: int = 32) -> Mesh:
    """A ring of radius 0.25 and thickness 0.2 that stands on the floor, turned towards the camera."""
    a, b = (np.arange(n) * (2 * np.pi / n) for n in (around, tube))
    axis = np.stack([np.cos(a), np.sin(a), np.zeros(around)], 1)
    normals = np.cos(b)[None, :, None] * axis[:, None] + np.sin(b)[None, :, None] * np.array([0, 0, 1.0])
    points = 0.25 * axis[:, None] + 0.1 * normals
    shape = _closed(points)
    rotation = rotation_about_y(-30)
    turned = Shape(shape.positions @ rotation.T + (0.42, 0.35, -0.3), shape.triangles)
    return mesh(turned, material, normals=normals.reshape(-1, 3) @ rotation.T, body="torus")


def _closed(points: NDArray[np.float64]) -> Shape:
    """A (rows, columns, 3) grid of points joined at both seams."""
    rows, columns = points.shape[:2]
    triangles = grid_triangles(rows + 1, columns, wrap=True) % np.uint32(rows * columns)
    return flipped(Shape(points.reshape(-1, 3), triangles))


def _grating(bars: int) -> Shape:
    """Bars of a tenth of their spacing at y = 1.7; those along z lie a little lower, so that no two faces coincide."""
    spacing = 2 / bars
    half = 0.05 * spacing
    places = (np.arange(bars) + 0.5) * spacing - 1
    along_x = [box((-0.999, 1.7, z - half), (0.999, 1.7 + 2 * half, z + half)) for z in places]
    along_z = [box((x - half, 1.7 - half, -0.999), (x + half, 1.7 + half, 0.999)) for x in places]
    return join([*along_x, *along_z])
