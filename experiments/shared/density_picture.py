"""A method whose picture says how densely a warp's voxels lie along x."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import place, trace_gbuffer


@method
class DensityPicture(Method):
    """Colour by the slope of the warp along x at the surface behind each pixel: red 0, green 1, blue 2, shaded by the surface's normal."""

    grid: _core.Grid = _core.Grid(resolution=256)

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        gbuffer = trace_gbuffer(view.scene, view.camera, view.size)
        with profile.stage("place"):
            domain = place(self.grid, view.scene, view.camera, view.size)
        density = domain.density(gbuffer.position.reshape(-1, 3))[:, 0, 0].reshape(gbuffer.depth.shape)
        even = domain.cells[0] / (domain.upper[0] - domain.lower[0])
        height = np.clip(density / even, 0, 2)[..., None]
        stops = np.array([[1, 0.1, 0.1], [0.1, 0.8, 0.1], [0.15, 0.25, 1]])
        colour = np.where(height < 1, stops[0] + height * (stops[1] - stops[0]), stops[1] + (height - 1) * (stops[2] - stops[1]))
        shading = 0.65 + 0.35 * gbuffer.geometric_normal @ np.array([0.36, 0.80, 0.48], np.float32)
        picture = (colour * (shading * np.isfinite(gbuffer.depth))[..., None]).astype(np.float32)
        return picture, np.zeros_like(picture)
