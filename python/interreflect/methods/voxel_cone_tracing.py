"""Voxel cone tracing: the scene's reflected light in voxels, gathered at the pixels by cones."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import stage
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_presets import PRESETS
from interreflect.methods.voxel_scene import VoxelMethod
from interreflect.profile import Profile
from interreflect.stages import glossy, march, shade, shadow, sky, trace_gbuffer


@method
class VoxelConeTracing(VoxelMethod):
    """One indirect bounce by cones through prefiltered voxels, after Crassin et al. 2011, Rehfeld et al. 2014 (section 3.1) and Freed 2018.

    Everything is done anew in every frame; only the ray hierarchy is kept, and the voxels' light by BlendHistory and Bounces.
    `glossy=None` leaves the glossy lobe's indirect light out. With `bodies="apart"` every body has a hierarchy of its own, which is
    voxelized once and lit and filtered in every frame [Rehfeld et al. 2014, 3.1]; light of all bounces cannot be gathered so.
    """

    march: Any = stage(default=_core.DiffuseCones())
    glossy: Any = stage(default=_core.GlossyCone(), optional=True)
    share: Any = stage(default=_core.Interleaved(width=4, height=4))
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.ConeSky())

    preset_values = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        pyramids = self.pyramids(view, profile, view.history)
        with profile.stage("march") as note:
            gathered = note(march(self.march, pyramids, gbuffer, scene, share=self.share, seed=seed))
        reflected = None
        if self.glossy is not None:
            with profile.stage("glossy") as note:
                reflected = note(glossy(self.glossy, pyramids, gbuffer, scene, seed=seed))
        with profile.stage("shadow") as note:
            lights = note(shadow(self.shadow, scene, gbuffer, seed, pyramids=pyramids))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed, gathered=gathered, glossy=reflected))
        kept = self.kept_light(pyramids)
        del pyramids  # whatever the next frame does not build on
        with profile.stage("shade"):
            indirect = shade(gbuffer, gathered, reflected)
            direct = gbuffer.emission + lights.radiance + environment.radiance
        return direct, indirect, kept
