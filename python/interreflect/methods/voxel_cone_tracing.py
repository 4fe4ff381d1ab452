"""Voxel cone tracing: the scene's reflected light in voxels, gathered at the pixels by cones."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_presets import PRESETS
from interreflect.profile import Profile
from interreflect.stages import (
    glossy,
    holds_all_bounces,
    light_history,
    light_voxels,
    march,
    place,
    prefilter,
    shade,
    shadow,
    sky,
    trace_gbuffer,
    voxelize,
)


@method
class VoxelConeTracing(Method):
    """One indirect bounce by cones through prefiltered voxels, after Crassin et al. 2011, Rehfeld et al. 2014 (section 3.1) and Freed 2018.

    Everything is done anew in every frame; only the ray hierarchy is kept, and the voxels' light by BlendHistory and Bounces.
    `glossy=None` leaves the glossy lobe's indirect light out.
    """

    grid: _core.Grid = _core.Grid(resolution=128)
    voxelize: Any = stage(default=_core.SurfaceSampling())
    light_voxels: Any = stage(default=_core.TracedLighting(both_sides=True))
    prefilter: Any = stage(default=_core.OctantCoverage())
    march: Any = stage(default=_core.DiffuseCones())
    glossy: Any = stage(default=_core.GlossyCone(), optional=True)
    share: Any = stage(default=_core.Interleaved(width=4, height=4))
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.ConeSky())

    preset_values = PRESETS

    @property
    def bounces(self) -> int | None:
        """One; all where `light_voxels` gathers them from frame to frame."""
        return None if holds_all_bounces(self.light_voxels) else 1

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        with profile.stage("voxelize") as note:
            voxels = note(voxelize(self.voxelize, scene, place(self.grid, scene, view.camera, view.size)))
        with profile.stage("light_voxels") as note:
            lit = note(light_voxels(self.light_voxels, scene, voxels, seed, history=view.history))
        with profile.stage("prefilter") as note:
            pyramid = note(prefilter(self.prefilter, lit))
        with profile.stage("march") as note:
            gathered = note(march(self.march, pyramid, gbuffer, scene, share=self.share, seed=seed))
        reflected = None
        if self.glossy is not None:
            with profile.stage("glossy") as note:
                reflected = note(glossy(self.glossy, pyramid, gbuffer, scene, seed=seed))
        with profile.stage("shadow") as note:
            lights = note(shadow(self.shadow, scene, gbuffer, seed, pyramids=[pyramid]))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed, gathered=gathered, glossy=reflected))
        with profile.stage("shade"):
            indirect = shade(gbuffer, gathered, reflected)
            direct = gbuffer.emission + lights.radiance + environment.radiance
        return direct, indirect, light_history(self.light_voxels, pyramid)
