"""The same scene elsewhere: scaled, turned about its up, moved, with lights and cameras along. Its pictures must not change."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.checks import Vector
from interreflect.scenes.compile import rotation_about
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, SpotLight
from interreflect.scenes.scene import Scene


def similar(scene: Scene, scale: float = 1.0, turn: float = 0.0, shift: ArrayLike = (0, 0, 0)) -> Scene:
    """The scene times `scale`, turned by `turn` degrees about its up, then moved by `shift` scene units (of the scaled scene).

    Intensities of point and spot lights grow by the square of the scale, so that irradiance stays. Bodies become part of the world.
    """
    rotation = rotation_about(np.asarray(scene.up, float), turn)
    placed = np.eye(4)
    placed[:3, :3], placed[:3, 3] = scale * rotation, np.asarray(shift, float)

    def point(p: Any) -> Vector:
        return _triple(placed[:3, :3] @ np.asarray(p, float) + placed[:3, 3])

    def light(one: Any) -> Any:
        if isinstance(one, EnvironmentLight):
            return dataclasses.replace(one, rotation=one.rotation + turn)
        if isinstance(one, DirectionalLight):
            return dataclasses.replace(one, direction=_triple(rotation @ np.asarray(one.direction)))
        if isinstance(one, SpotLight):
            one = dataclasses.replace(one, direction=_triple(rotation @ np.asarray(one.direction)))
        return dataclasses.replace(one, position=point(one.position), intensity=_triple(np.multiply(one.intensity, scale**2)))

    cameras = {
        name: dataclasses.replace(c, position=point(c.position), target=point(c.target), up=_triple(rotation @ np.asarray(c.up)))
        for name, c in scene.cameras.items()
    }
    meshes = [mesh.replace(body="world", transform=placed @ scene.bodies[mesh.body] @ mesh.transform) for mesh in scene.meshes]
    return Scene(meshes=meshes, lights=[light(one) for one in scene.lights], cameras=cameras, name=scene.name, up=scene.up)


def _triple(values: NDArray[np.float64]) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
