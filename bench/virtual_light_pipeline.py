"""What the suite `virtual-lights` measures: two scenes by a spot, and the paper's "64 with PCSS" with its stages' inputs, made once."""

from __future__ import annotations

import dataclasses
import functools
from typing import Any

import interreflect as ir
from bench.sponza import SIZE
from bench.timing import Work, timed
from interreflect import stages

LIGHTS = 64
STAGES = ("reflective_shadow_maps", "sample_lights", "cluster_lights", "shadow_lights", "shade_lights")
SPP = 256  # of the truth


@dataclasses.dataclass(frozen=True)
class Room:
    """A scene by one spot, and how it is seen."""

    name: str
    scene: ir.Scene
    camera: str

    @property
    def pixels(self) -> int:
        return SIZE[0] * SIZE[1]

    @functools.cached_property
    def truth(self) -> Any:
        return ir.reference(self.scene, self.camera, SIZE, bounces=1, noise=1e-4, max_spp=SPP)


def rooms(sponza: ir.Scene | None) -> list[Room]:
    """Sponza's spot shines from under the roof across the nave, on the floor and the arcade that the camera sees."""
    found = [Room("Cornell box", ir.scenes.cornell_box(light="spot", box="glossy"), "front")]
    if sponza is not None:
        spot = ir.SpotLight(position=(-700, 800, 100), direction=(0.75, -0.6, -0.3), intensity=(4e6, 3.6e6, 3e6), inner=32, outer=40)
        found.append(Room("Sponza", sponza.replace(lights=[spot], name="Sponza by a spot"), "nave"))
    return found


def method(lights: int = LIGHTS, preset: str = "64 with PCSS") -> ir.methods.VirtualAreaLights:
    """The preset with so many lights."""
    way: Any = ir.methods.VirtualAreaLights.preset(preset)
    made: ir.methods.VirtualAreaLights = way.replace(sample_lights=way.sample_lights.replace(lights=lights))
    return made


class Pipeline:
    """One run of the stages for a number of lights: results, and works that repeat each stage."""

    def __init__(self, room: Room, lights: int) -> None:
        self.room, self.way = room, method(lights)
        scene, way = room.scene, self.way
        self.points = stages.scatter_points(way.shadow_lights, scene)
        self.gbuffer = stages.trace_gbuffer(scene, room.camera, SIZE, way.shade)
        self.maps = stages.light_maps(scene, way.map_size)
        self.seeds = stages.sample_lights(way.sample_lights, self.maps)
        self.lights = stages.cluster_lights(way.cluster_lights, self.seeds, self.maps)
        self.shadows = stages.shadow_lights(way.shadow_lights, self.lights, scene, self.points)

    def shaded(self) -> Any:
        way = self.way
        return stages.shade_lights(
            way.shade_lights, self.lights, self.shadows, self.gbuffer, self.room.scene, way.filter_shadows, way.share
        )  # fmt: skip

    def works(self) -> list[Work]:
        """In the order of STAGES."""
        way, scene = self.way, self.room.scene
        return [
            timed(lambda: stages.light_maps(scene, way.map_size)),
            timed(lambda: stages.sample_lights(way.sample_lights, self.maps)),
            timed(lambda: stages.cluster_lights(way.cluster_lights, self.seeds, self.maps)),
            timed(lambda: stages.shadow_lights(way.shadow_lights, self.lights, scene, self.points)),
            timed(self.shaded),
        ]

    def one_iteration(self) -> Work:
        once = self.way.cluster_lights.replace(iterations=1)
        return timed(lambda: stages.cluster_lights(once, self.seeds, self.maps))

    @property
    def texels(self) -> int:
        """Of the reflective shadow map."""
        return int(self.way.map_size) ** 2

    def splat_texels(self) -> int:
        """Texels that the seeds' splats cover, each splat's for itself."""
        side, reach = int(self.way.map_size), int(self.way.cluster_lights.splat_size)
        rows, columns = self.seeds.texel // side, self.seeds.texel % side
        inside = [(at + (reach - 1) // 2).clip(max=side - 1) - (at.astype(int) - reach // 2).clip(min=0) + 1 for at in (rows, columns)]
        return int((inside[0] * inside[1]).sum())
