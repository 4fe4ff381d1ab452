"""Clustered pre-convolved radiance caching: radiance is gathered where clusters of pixels need it, convolved once, and shared."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.cache_presets import PRESETS
from interreflect.methods.knobs import stage
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_scene import VoxelMethod
from interreflect.profile import Profile
from interreflect.stages import distribute, fill, interpolate, preconvolve, shade, shadow, sky, trace_gbuffer


@dataclass(frozen=True)
class CacheHistory:
    """What a frame leaves to the next: where its caches stood, and its voxels' light."""

    places: _core.CachePlaces | None
    light: Any


@method
class ClusteredRadianceCaching(VoxelMethod):
    """One indirect bounce by radiance caches that cones fill from prefiltered voxels [Rehfeld, Zirr and Dachsbacher 2014].

    Caches stand where clusters of the picture's pixels need them. Each is a hemisphere map of incident radiance, convolved for lobes of
    every width, diffuse and glossy, and shared by the pixels around it. With `Evaluated` every pixel has a cache of its own, and
    `distribute` does not matter.
    """

    distribute: Any = stage(default=_core.Clustered())
    fill: Any = stage(default=_core.ConeFill())
    preconvolve: Any = stage(default=_core.MipChain())
    interpolate: Any = stage(default=_core.Gather())
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.ConeSky())

    preset_values = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        last = view.history if view.history is not None else CacheHistory(None, None)
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        pyramids = self.pyramids(view, profile, last.light)
        places, caches = None, None
        if not isinstance(self.interpolate, _core.Evaluated):
            with profile.stage("distribute") as note:
                places = note(distribute(self.distribute, gbuffer, scene, last.places))
            with profile.stage("fill") as note:
                filled = note(fill(self.fill, places, pyramids, scene, seed))
            with profile.stage("preconvolve") as note:
                caches = note(preconvolve(self.preconvolve, filled))
        with profile.stage("interpolate") as note:
            light = note(interpolate(self.interpolate, caches, gbuffer, scene, pyramids, self.fill, self.preconvolve, seed))
        with profile.stage("shadow") as note:
            lights = note(shadow(self.shadow, scene, gbuffer, seed, pyramids=pyramids))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed, gathered=light.gathered, glossy=light.glossy))
        kept = CacheHistory(places, self.kept_light(pyramids))
        del pyramids  # whatever the next frame does not build on
        with profile.stage("shade"):
            indirect = shade(gbuffer, light.gathered, light.glossy)
            direct = gbuffer.emission + lights.radiance + environment.radiance
        return direct, indirect, kept
