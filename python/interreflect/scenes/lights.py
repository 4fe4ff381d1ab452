"""Lights other than emitting triangles. Linear radiometric units."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.checks import Vector, direction, number, vector
from interreflect.scenes.content import Content
from interreflect.scenes.digest import digest
from interreflect.scenes.texture import linear_image


@dataclass(frozen=True, kw_only=True)
class PointLight:
    """The same intensity, W/sr, in every direction. ValueError names the argument and its value."""

    position: Vector
    intensity: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", vector("position", self.position))
        object.__setattr__(self, "intensity", vector("intensity", self.intensity, 0))

    @property
    def hash(self) -> str:
        return digest("point", self.position, self.intensity)


@dataclass(frozen=True, kw_only=True)
class SpotLight:
    """Full intensity, W/sr, inside `inner`, none outside `outer` (half angles, degrees), smoothstep of the cosine between them.

    t^2 (3 - 2t), t = (cos - cos outer) / (cos inner - cos outer); inner = outer is a hard edge. `direction` is made unit length.
    """

    position: Vector
    direction: Vector
    intensity: Vector
    inner: float
    outer: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", vector("position", self.position))
        object.__setattr__(self, "direction", direction("direction", self.direction))
        object.__setattr__(self, "intensity", vector("intensity", self.intensity, 0))
        object.__setattr__(self, "outer", number("outer", self.outer, 0, 90, open_low=True))
        object.__setattr__(self, "inner", number("inner", self.inner, 0, 90))
        if self.inner > self.outer:
            raise ValueError(f"inner must not exceed outer ({self.outer:g} degrees), got {self.inner:g}")

    @property
    def hash(self) -> str:
        return digest("spot", self.position, self.direction, self.intensity, self.inner, self.outer)


@dataclass(frozen=True, kw_only=True)
class DirectionalLight:
    """Light that travels along `direction` (made unit length); irradiance, W/m^2, on a surface facing it."""

    direction: Vector
    irradiance: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", direction("direction", self.direction))
        object.__setattr__(self, "irradiance", vector("irradiance", self.irradiance, 0))

    @property
    def hash(self) -> str:
        return digest("directional", self.direction, self.irradiance)


@dataclass(frozen=True, kw_only=True, eq=False)
class EnvironmentLight(Content):
    """Light from infinity: a constant radiance, W/(m^2 sr), or a latitude-longitude image scaled by it.

    image: (height, width, 3) float, linear, or None. rotation: degrees counter-clockwise about the scene's up; at 0 the image's
    centre lies at -z for up = +y, and seen from inside u grows to the right; another up: that frame turned the shortest way.
    """

    radiance: Vector = (1.0, 1.0, 1.0)
    image: NDArray[np.float32] | None = field(default=None, repr=False)
    rotation: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "radiance", vector("radiance", self.radiance, 0))
        object.__setattr__(self, "rotation", number("rotation", self.rotation))
        if self.image is not None:
            object.__setattr__(self, "image", linear_image("image", self.image))

    def _digest(self) -> str:
        return digest("environment", self.radiance, self.image, self.rotation)


Light = PointLight | SpotLight | DirectionalLight | EnvironmentLight
