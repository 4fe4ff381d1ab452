"""A method whose picture is what the cones leave open."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import light_voxels, march, place, prefilter, trace_gbuffer, voxelize


@method
class OcclusionPicture(Method):
    """The cosine-weighted share of each pixel's hemisphere that the voxels leave open, grey; 0 where nothing is seen."""

    grid: _core.Grid = _core.Grid(resolution=256)
    voxelize: Any = stage(default=_core.SurfaceSampling())
    light_voxels: Any = stage(default=_core.TracedLighting())
    prefilter: Any = stage(default=_core.VolumeCoverage())
    march: Any = stage(default=_core.DiffuseCones())
    share: Any = stage(default=_core.EveryPixel())

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        gbuffer = trace_gbuffer(view.scene, view.camera, view.size)
        with profile.stage("voxelize") as note:
            voxels = note(voxelize(self.voxelize, view.scene, place(self.grid, view.scene, view.camera, view.size)))
        pyramid = prefilter(self.prefilter, light_voxels(self.light_voxels, view.scene, voxels, view.seed))
        with profile.stage("march") as note:
            gathered = note(march(self.march, pyramid, gbuffer, view.scene, share=self.share, seed=view.seed))
        is_open = np.where(np.isfinite(gbuffer.depth), 1 - gathered.occlusion, 0).astype(np.float32)
        picture = np.repeat(is_open[..., None], 3, axis=2)
        return picture, np.zeros_like(picture)
