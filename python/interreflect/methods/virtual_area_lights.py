"""Virtual area lights: lit surface is clustered in the lights' view; the clusters light the picture, with shadows by rays or maps."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import View
from interreflect.methods.suns import suns_of
from interreflect.methods.virtual_light_presets import PRESETS
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
from interreflect.stages import (
    bounce_maps,
    cluster_lights,
    join_lights,
    light_maps,
    sample_lights,
    scatter_points,
    shade,
    shade_lights,
    shadow,
    shadow_lights,
    sky,
    trace_gbuffer,
)


@dataclass(frozen=True)
class LightHistory:
    """What a frame leaves to the next: its lights, bounce by bounce."""

    lights: tuple[_core.VirtualLights, ...]


@method
class VirtualAreaLights(Method):
    """Indirect light of virtual area lights [Weinzierl-Heigl 2013].

    Reflective shadow maps hold what every light of the scene sees. Seeds in them grow to clusters, each a light that sends on its texels'
    flux; each pixel of a block takes its part of the lights. How much of one it sees rays to its texels tell, drawn by the light that they
    would bring; in the paper, and in its presets, a small map of points that the light's disk sees (`ImperfectShadowMaps`, `Pcss`). These
    points are shared by all lights: where the scene is large they leave it leaking.
    Without `cluster_lights` the seeds are lights themselves. With more than one of `bounces` the lights send light on in turn: a map of
    what each sees is sampled and clustered in the same way, into as many lights again.
    """

    map_size: int = knob(
        default=512, doc="side of the map of each light; emitters together and the environment together have as many texels",
        unit="texels", minimum=1, maximum=16384,
    )  # fmt: skip
    emitter_views: int = knob(default=16, doc="points on emitters from which maps are made", minimum=1, maximum=4096)
    environment_lights: int = knob(default=16, doc="directional lights that stand for the environment", minimum=1, maximum=4096)
    bounces: int = knob(default=1, doc="most indirect bounces", minimum=1, maximum=16)

    sample_lights: Any = stage(default=_core.HaltonLights())
    cluster_lights: Any = stage(default=_core.KMeans(), optional=True)
    shadow_lights: Any = stage(default=_core.TracedVisibility())
    filter_shadows: Any = stage(default=_core.TracedDisk())
    shade_lights: Any = stage(default=_core.MemberBoundedDisk())
    share: Any = stage(default=_core.Interleaved(width=4, height=4))
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.TracedSky())

    preset_values = PRESETS

    def __post_init__(self) -> None:
        super().__post_init__()
        if isinstance(self.sky, _core.ConeSky):
            raise ValueError("VirtualAreaLights.sky: ConeSky needs cones, and virtual lights have none")

    def precompute(self, scene: Scene, pieces: Pieces) -> dict[str, Any]:
        return {"points": scatter_points(self.shadow_lights, scene)}

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        bounced = self.lights_of_bounces(view, profile)
        lights = join_lights(bounced)
        with profile.stage("shadow_lights") as note:
            shadows = note(shadow_lights(self.shadow_lights, lights, scene, view.state["points"]))
        with profile.stage("shade_lights") as note:
            light = note(
                shade_lights(self.shade_lights, lights, shadows, gbuffer, scene, self.filter_shadows, self.share, seed)
            )  # fmt: skip
        with profile.stage("shadow") as note:
            direct_light = note(shadow(self.shadow, scene, gbuffer, seed))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed))
        with profile.stage("shade"):
            indirect = shade(gbuffer, light.gathered, light.glossy)
            direct = gbuffer.emission + direct_light.radiance + environment.radiance
        return direct, indirect, LightHistory(bounced)

    def lights_of_bounces(self, view: View, profile: Profile) -> tuple[_core.VirtualLights, ...]:
        last = view.history.lights if view.history is not None else ()
        made: list[_core.VirtualLights] = []
        for bounce in range(self.bounces):
            with profile.stage("reflective_shadow_maps") as note:
                if bounce == 0:
                    maps = note(light_maps(view.scene, self.map_size, self.emitter_views, suns_of(view, self.environment_lights)))
                else:
                    maps = note(bounce_maps(view.scene, made[-1], self.map_size))
            with profile.stage("sample_lights") as note:
                lights = note(sample_lights(self.sample_lights, maps, view.seed))
            if self.cluster_lights is not None:
                with profile.stage("cluster_lights") as note:
                    before = last[bounce] if bounce < len(last) else None
                    lights = note(cluster_lights(self.cluster_lights, lights, maps, before, view.seed))
            made.append(lights)
        return tuple(made)
