"""A pinhole camera."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from interreflect.scenes.checks import Vector, direction, number, vector


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A pinhole at `position` that looks at `target`; pixel (0, 0) is top left.

    up: any vector not parallel to the view. fov_x: horizontal field of view, degrees, in (0, 180).
    size: (width, height) in pixels, the default of pictures taken with it. ValueError names the argument and its value.
    """

    position: Vector
    target: Vector
    fov_x: float
    up: Vector = (0.0, 1.0, 0.0)
    size: tuple[int, int] = (1280, 720)

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", vector("position", self.position))
        object.__setattr__(self, "target", vector("target", self.target))
        view = np.subtract(self.target, self.position).astype(np.float64)
        if not view.any():
            raise ValueError(f"target must differ from position, got {list(self.target)} for both")
        up = direction("up", self.up)
        object.__setattr__(self, "up", vector("up", self.up))
        if float(np.linalg.norm(np.cross(view / np.linalg.norm(view), up))) < 1e-6:
            raise ValueError(f"up must not be parallel to the view, got {list(self.up)} along {view.tolist()}")
        object.__setattr__(self, "fov_x", self._checked_fov())
        object.__setattr__(self, "size", checked_size(self.size))

    def _checked_fov(self) -> float:
        angle = number("fov_x", self.fov_x)
        if not 0 < angle < 180:
            raise ValueError(f"fov_x must lie in (0, 180) degrees, got {angle:g}")
        return angle


def checked_size(size: object) -> tuple[int, int]:
    """(width, height), both from 1 to 16384."""
    items = list(size) if isinstance(size, (tuple, list)) else []
    whole = all(isinstance(x, (int, np.integer)) and not isinstance(x, bool) for x in items)
    if len(items) != 2 or not whole or not all(1 <= x <= 16384 for x in items):
        raise ValueError(f"size must be (width, height), whole numbers from 1 to 16384, got {size!r}")
    return int(items[0]), int(items[1])
