"""Light propagation volumes: lit surface sends light into the cells of a grid, which pass it on from neighbour to neighbour."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.composition_pieces import without_bodies
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import View
from interreflect.methods.suns import suns_of
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
from interreflect.stages import (
    geometry_volume,
    inject,
    light_maps,
    look_up,
    place,
    place_surfels,
    propagate,
    sample_lights,
    shade,
    shadow,
    sky,
    trace_gbuffer,
)


@method
class LightPropagationVolumes(Method):
    """One bounce through a grid of two bands of spherical harmonics [Kaplanyan and Dachsbacher 2010], one cascade, diffuse light alone.

    Texels of reflective shadow maps light the cells before them. Surfels of what stands still, placed once, block light on its way;
    without `place_surfels` nothing does.
    """

    map_size: int = knob(
        default=256, doc="side of the map of each light; emitters together and the environment together have as many texels",
        unit="texels", minimum=1, maximum=16384,
    )  # fmt: skip
    emitter_views: int = knob(default=16, doc="points on emitters from which maps are made", minimum=1, maximum=4096)
    environment_lights: int = knob(default=16, doc="directional lights that stand for the environment", minimum=1, maximum=4096)

    grid: _core.Grid = _core.Grid(resolution=32)
    place_surfels: Any = stage(default=_core.HaltonSurfels(surfels=65536), optional=True)
    sample_lights: Any = stage(default=_core.EveryRsmPixel(samples=0))
    propagate: Any = stage(default=_core.LightPropagation())
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.TracedSky())

    bounces = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not isinstance(self.grid.warp, _core.Linear) or self.grid.cascades > 1:
            raise ValueError("LightPropagationVolumes.grid: light propagates through one grid of evenly spread cells")
        if isinstance(self.sky, _core.ConeSky):
            raise ValueError("LightPropagationVolumes.sky: ConeSky needs cones, and light volumes have none")
        if isinstance(self.shadow, _core.VoxelCones):
            raise ValueError("LightPropagationVolumes.shadow: VoxelCones needs voxels, and light volumes have none")

    def precompute(self, scene: Scene, pieces: Pieces) -> dict[str, Any]:
        if self.place_surfels is None:
            return {}
        return {"surfels": place_surfels(self.place_surfels, without_bodies(scene))}

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        with profile.stage("reflective_shadow_maps") as note:
            maps = note(light_maps(scene, self.map_size, self.emitter_views, suns_of(view, self.environment_lights)))
        with profile.stage("sample_lights") as note:
            lights = note(sample_lights(self.sample_lights, maps, seed))
        domain = place(self.grid, scene, view.camera, view.size)
        with profile.stage("inject") as note:
            injected = note(inject(lights, domain))
        blockers = None
        if self.place_surfels is not None:
            with profile.stage("geometry_volume") as note:
                blockers = note(geometry_volume(view.state["surfels"], domain))
        with profile.stage("propagate") as note:
            volume = note(propagate(self.propagate, injected, blockers))
        with profile.stage("look_up") as note:
            gathered = note(look_up(volume, gbuffer))
        with profile.stage("shadow") as note:
            lights_seen = note(shadow(self.shadow, scene, gbuffer, seed))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed))
        with profile.stage("shade"):
            indirect = shade(gbuffer, gathered)
            direct = gbuffer.emission + lights_seen.radiance + environment.radiance
        return direct, indirect
