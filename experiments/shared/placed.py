"""The same scene elsewhere: scaled, turned and moved, its pictures unchanged."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir

Matrix = NDArray[np.float64]


def turned(degrees: float, axis: tuple[float, float, float] = (0, 1, 0)) -> Matrix:
    """The (3, 3) rotation about an axis, by Rodrigues' formula."""
    x, y, z = np.asarray(axis, np.float64) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def placed(scene: ir.Scene, scale: float = 1.0, turn: Matrix | None = None, shift: Any = (0, 0, 0)) -> ir.Scene:
    """`scene` scaled about the origin, turned and moved, lights and cameras with it; intensities grow with the square of the scale.

    Without bodies and images of the sky.
    """
    turn, shift = np.eye(3) if turn is None else turn, np.asarray(shift, np.float64)
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = scale * turn, shift

    def point(p: Any) -> tuple[float, float, float]:
        x, y, z = (scale * turn @ np.asarray(p, np.float64) + shift).tolist()
        return x, y, z

    def light_there(light: Any) -> Any:
        changes: dict[str, Any] = {}
        if hasattr(light, "position"):
            changes |= {"position": point(light.position), "intensity": tuple(scale**2 * v for v in light.intensity)}
        if hasattr(light, "direction"):
            changes["direction"] = tuple((turn @ np.asarray(light.direction, np.float64)).tolist())
        return dataclasses.replace(light, **changes)

    cameras = {
        name: dataclasses.replace(
            c, position=point(c.position), target=point(c.target), up=tuple((turn @ np.asarray(c.up, np.float64)).tolist())
        )
        for name, c in scene.cameras.items()
    }
    return ir.Scene(
        meshes=[mesh.replace(transform=matrix @ mesh.transform) for mesh in scene.meshes],
        lights=[light_there(light) for light in scene.lights],
        cameras=cameras,
        name=scene.name,
    )
