"""Voxel cone tracing: the scene's reflected light in voxels, gathered at the pixels by cones."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.bodies import parts_of, voxelize_bodies
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_presets import PRESETS
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
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
    `glossy=None` leaves the glossy lobe's indirect light out. With `bodies="apart"` every body has a hierarchy of its own, which is
    voxelized once and lit and filtered in every frame [Rehfeld et al. 2014, 3.1]; light of all bounces cannot be gathered so.
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

    bodies: str = knob(
        default="together", doc="whether bodies share the scene's voxels, or keep voxels of their own that move with them",
        choices=("together", "apart"),
    )  # fmt: skip

    preset_values = PRESETS

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.bodies == "apart" and holds_all_bounces(self.light_voxels):
            raise ValueError("VoxelConeTracing: Bounces gathers in one hierarchy; it does not go with bodies='apart'")

    def precompute(self, scene: Scene) -> dict[str, Any]:
        """Voxels of the bodies, as large as those of the first camera's grid; without a camera they wait for the first frame."""
        if self.bodies == "together" or not scene.cameras:
            return {}
        return {"bodies": voxelize_bodies(self.voxelize, scene, place(self.grid, scene).voxel_size)}

    @property
    def bounces(self) -> int | None:
        """One; all where `light_voxels` gathers them from frame to frame."""
        return None if holds_all_bounces(self.light_voxels) else 1

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        with profile.stage("voxelize") as note:
            domain = place(self.grid, scene, view.camera, view.size)
            apart = self.bodies == "apart"
            parts = parts_of(self.voxelize, view, domain, note) if apart else [note(voxelize(self.voxelize, scene, domain))]
        with profile.stage("light_voxels") as note:
            lit = [note(self._light(scene, parts, k, seed, view.history)) for k in range(len(parts))]
        with profile.stage("prefilter") as note:
            pyramids = [note(prefilter(self.prefilter, one)) for one in lit]
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
        kept = [light_history(self.light_voxels, pyramid) for pyramid in pyramids]
        del parts, lit, pyramids  # whatever the next frame does not build on
        with profile.stage("shade"):
            indirect = shade(gbuffer, gathered, reflected)
            direct = gbuffer.emission + lights.radiance + environment.radiance
        return direct, indirect, kept if apart and kept[0] is not None else kept[0]

    def _light(self, scene: Scene, parts: list[_core.VoxelGrid], k: int, seed: int, history: Any) -> _core.LitVoxels:
        """Part k, as lit as the others let it be."""
        last = history[k] if isinstance(history, list) else history
        return light_voxels(self.light_voxels, scene, parts[k], seed, history=last, others=parts[:k] + parts[k + 1 :])
