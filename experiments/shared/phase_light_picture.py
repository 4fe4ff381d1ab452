"""A method whose picture is the light that each pixel gets from its own part of the virtual lights, before neighbours are merged."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from experiments.shared.split_picture import split
from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.virtual_area_lights import VirtualAreaLights
from interreflect.methods.virtual_light_presets import PRESETS
from interreflect.profile import Profile
from interreflect.stages import join_lights, shade, shade_lights, shadow_lights, trace_gbuffer


@method
class PhaseLightPicture(VirtualAreaLights):
    """Indirect light of the lights that each pixel of an interleaved block does itself, over their share of all flux: as many lights
    as phases do each a run of them. `tiles`: the pixels of each phase in a tile of their own; else where they stand."""

    tiles: bool = knob(default=True, doc="the pixels of each phase in a tile of their own")

    preset_values: ClassVar[Any] = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, blocks = view.scene, self.share
        gbuffer = trace_gbuffer(scene, view.camera, view.size, self.shade)
        lights = join_lights(self.lights_of_bounces(view, profile))
        shadows = shadow_lights(self.shadow_lights, lights, scene, view.state["points"])
        picture = np.zeros((*gbuffer.depth.shape, 3), np.float32)
        with profile.stage("shade_lights"):
            for phase, (part, share) in enumerate(parts(lights, blocks.width * blocks.height)):
                light = shade_lights(self.shade_lights, part, shadows, gbuffer, scene, self.filter_shadows, seed=view.seed)
                own = slice(phase // blocks.width, None, blocks.height), slice(phase % blocks.width, None, blocks.width)
                if share > 0:
                    picture[own] = shade(gbuffer, light.gathered, light.glossy)[own] / share
        shown = split(picture, blocks.width, blocks.height) if self.tiles else picture
        return np.zeros_like(shown), shown, None


def parts(lights: _core.VirtualLights, phases: int) -> Iterator[tuple[_core.VirtualLights, float]]:
    """Of each phase all lights, those of other phases dark, and its share of the flux. Phases have lights that follow each other."""
    luminance = lights.flux @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    for phase in range(phases):
        begin, end = (len(lights) * k // phases for k in (phase, phase + 1))
        flux: NDArray[np.float32] = np.zeros_like(lights.flux)
        flux[begin:end] = lights.flux[begin:end]
        part = _core.VirtualLights(lights.position, lights.normal, flux, lights.area, lights.offset)
        yield part, float(luminance[begin:end].sum() / max(luminance.sum(), 1e-30))
