"""Cameras that measure: pictures whose plain mean is a mean over a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from interreflect.scenes.builtin.shapes import triple
from interreflect.scenes.values import Camera


def facing_camera(centre: ArrayLike, normal: ArrayLike, *, half_width: float, distance: float) -> Camera:
    """A camera straight before a flat square that sees exactly that square.

    The image plane is parallel to the square, so equal pixels are equal areas of it. `half_width` is half of the square's side,
    `distance` that of the pinhole from `centre` along the unit vector `normal`. The square's sides run along the axes.
    """
    point, away = np.asarray(centre, float), np.asarray(normal, float)
    up = (0.0, 0.0, -1.0) if abs(away[1]) > 0.5 else (0.0, 1.0, 0.0)
    eye = point + distance * away
    angle = 2 * np.degrees(np.arctan(half_width / distance))
    return Camera(position=triple(eye), target=triple(point), up=up, fov_x=float(angle), size=(256, 256))


def point_camera(point: ArrayLike, normal: ArrayLike = (0, 1, 0), *, distance: float) -> Camera:
    """A camera straight above a point, so narrow (1 degree) that light changes over its picture to second order only."""
    return facing_camera(point, normal, half_width=float(distance * np.tan(np.radians(0.5))), distance=distance)
