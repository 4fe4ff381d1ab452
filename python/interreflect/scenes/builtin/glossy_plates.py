"""Glossy plates under lamps of different size: from sharp mirror images to wide highlights [after Veach 1997, 9.2]."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.knobs import Knob, built_in
from interreflect.scenes.builtin.shapes import Shape, box, join, mesh, quad, sphere, triple
from interreflect.scenes.values import Camera, Material, Mesh, Scene

LOBES = ("ggx", "phong", "blinn-phong")
ROUGHNESS = (0.1, 0.2, 0.32, 0.5)  # front to back
RADII = (0.04, 0.12, 0.3, 0.75)  # left to right
TINTS = ((1.0, 0.75, 0.5), (0.65, 1.0, 0.6), (0.6, 0.75, 1.0), (1.0, 0.65, 0.9))
EYE = np.array([0.0, 4.2, 10.5])
LAMPS = [np.array([x, 4.6, -3.0]) for x in (-3.3, -1.4, 0.7, 3.2)]


@built_in
def glossy_plates(
    lobe: Annotated[str, Knob("of the plates; Phong exponents match the roughness", choices=LOBES)] = "ggx",
    specular: Annotated[float, Knob("reflectance of the lobe", 0, 0.9)] = 0.6,
) -> Scene:
    """Four plates, each rougher than the one before it, that mirror four round lamps of equal flux into the camera "front".

    Exponents are 2 / alpha^2 - 2.
    """
    meshes = [_stage(), *(_plate(k, _metal(k, lobe, specular)) for k in range(len(ROUGHNESS))), *map(_lamp, range(len(RADII)))]
    camera = Camera(position=triple(EYE), target=(0, 1.85, 0), fov_x=58)
    return Scene(meshes=meshes, cameras={"front": camera})


def _stage() -> Mesh:
    floor = quad((-9, 0, 12), (18, 0, 0), (0, 0, -17))
    back = quad((-9, 0, -5), (18, 0, 0), (0, 8, 0))
    return mesh(join([floor, back]), Material(name="stage", albedo=(0.35, 0.35, 0.35)))


def _metal(k: int, lobe: str, specular: float) -> Material:
    plate = Material(name=f"plate {k + 1}", albedo=(0.07, 0.07, 0.07), specular=(specular,) * 3, roughness=ROUGHNESS[k])
    return plate if lobe == "ggx" else plate.replace(lobe=lobe, exponent=2 / ROUGHNESS[k] ** 4 - 2)


def _plate(k: int, material: Material) -> Mesh:
    """A slab that is tilted about x so that the camera sees the row of lamps in its middle."""
    centre = np.array([0, 0.4 + 0.62 * k, 2.9 - 1.5 * k])
    lamp = np.array([0, LAMPS[0][1], LAMPS[0][2]])
    normal = _unit(_unit(EYE - centre) + _unit(lamp - centre))
    slab = box((-4.2, -0.1, -0.6), (4.2, 0, 0.6))
    axes = np.stack([(1.0, 0.0, 0.0), normal, np.cross((1.0, 0.0, 0.0), normal)])
    return mesh(Shape(slab.positions @ axes + centre, slab.triangles), material)


def _lamp(k: int) -> Mesh:
    radiance = 2.0 / (4 * np.pi**2 * RADII[k] ** 2) * 10 * np.array(TINTS[k])
    glow = Material(name=f"lamp {k + 1}", albedo=(0, 0, 0), emission=triple(radiance))
    return mesh(sphere(RADII[k], centre=LAMPS[k], segments=24), glow)


def _unit(v: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(v / np.linalg.norm(v))
