"""A method whose picture is a view volume's voxels from outside of it."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np

from interreflect import _core
from interreflect.cubes import voxel_view
from interreflect.frame import Image
from interreflect.methods.knobs import stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import place, voxelize


@method
class FrustumPicture(Method):
    """The voxels that stand where the camera looks, as an eye behind, above and beside it sees them."""

    grid: _core.Grid = _core.Grid(resolution=32)
    voxelize: Any = stage(default=_core.SurfaceSampling())

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        camera = view.camera
        with profile.stage("voxelize") as note:
            voxels = note(voxelize(self.voxelize, view.scene, place(self.grid, view.scene, camera, view.size)))
        position, up = np.asarray(camera.position), np.asarray(camera.up)
        ahead = np.subtract(camera.target, camera.position)
        ahead /= np.linalg.norm(ahead)
        extent = float(np.ptp(np.asarray(view.scene.bounds), axis=0).max())
        eye = position + extent * (1.1 * up + 0.7 * np.cross(ahead, up) - 0.3 * ahead)
        outside = dataclasses.replace(camera, position=tuple(eye), target=tuple(position + 0.5 * extent * ahead), fov_x=65)
        with profile.stage("view"):
            picture = voxel_view(voxels, outside, view.size).image
        return picture, np.zeros_like(picture)
