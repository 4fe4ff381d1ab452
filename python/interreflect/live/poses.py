"""Between the scene's cameras and the page's: lengths in the page are such that its keys cross the scene in some seconds."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene

Vector = NDArray[np.float64]
EXTENT = 10.0  # of the scene's longest side in the page, whose keys move the camera by 2 a second
ROLL = 1e-3  # sine of the angle below which a camera counts as upright


@dataclass(frozen=True)
class Pose:
    """A camera in the page's lengths. fov: vertical, radians. up: about which the mouse turns."""

    position: Vector
    look_at: Vector
    up: Vector
    fov: float


@dataclass(frozen=True)
class Space:
    """The page's space: the scene about its centre, scaled."""

    centre: Vector
    scale: float
    up: Vector

    @staticmethod
    def of(scene: Scene) -> Space:
        bounds = np.asarray(scene.bounds, np.float64)
        longest = float((bounds[1] - bounds[0]).max())
        return Space(bounds.mean(0), EXTENT / longest if longest > 0 else 1.0, np.asarray(scene.up, np.float64))

    def pose(self, camera: Camera, aspect: float) -> Pose:
        """aspect: width over height of the page's picture, which shows all that the camera does, and more at two sides."""
        position, target = np.asarray(camera.position, np.float64), np.asarray(camera.target, np.float64)
        ahead = (target - position) / np.linalg.norm(target - position)
        own = np.asarray(camera.up, np.float64) / np.linalg.norm(camera.up)
        rolled = abs(float(np.cross(ahead, self.up) @ own)) > ROLL or float(np.linalg.norm(np.cross(ahead, self.up))) < ROLL
        fov = 2 * math.atan(math.tan(math.radians(camera.fov_x) / 2) / min(aspect, camera.size[0] / camera.size[1]))
        return Pose((position - self.centre) * self.scale, (target - self.centre) * self.scale, own if rolled else self.up, fov)

    def camera(self, position: Vector, look_at: Vector, wxyz: Vector, fov: float, aspect: float, size: tuple[int, int]) -> Camera:
        """Of the page's camera: `wxyz` turns x right, y down, z ahead into the page's axes; fov: vertical, radians."""
        w, x, y, z = wxyz / np.linalg.norm(wxyz)
        down = np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)])
        ahead = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
        distance = max(float(np.linalg.norm(look_at - position)), 1e-3)
        return Camera(
            position=_world(position / self.scale + self.centre), target=_world((position + distance * ahead) / self.scale + self.centre),
            up=_world(-down), fov_x=math.degrees(2 * math.atan(math.tan(fov / 2) * aspect)), size=size,
        )  # fmt: skip


def _world(vector: Vector) -> tuple[float, float, float]:
    x, y, z = (float(number) for number in vector)
    return x, y, z
