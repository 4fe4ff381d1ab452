"""Constant ambient light: direct light as it is, indirect light the same everywhere. The baseline that every method must beat."""

from __future__ import annotations

from typing import Any

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import shadow, sky, trace_gbuffer


@method
class ConstantAmbient(Method):
    """Indirect light = albedo * ambient * (the mean of the diffusely reflected direct light over the picture).

    One number per colour for the whole picture, which keeps it independent of exposure: the mean radiance that the visible surfaces reflect
    is taken for the radiance that arrives from everywhere.
    """

    ambient: float = knob(default=1.0, doc="indirect light as a multiple of the mean reflected direct light", minimum=0.0)
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.TracedSky())

    bounces = 1

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(view.scene, view.camera, view.size))
        with profile.stage("shadow") as note:
            lit = note(shadow(self.shadow, view.scene, gbuffer, view.seed))
        with profile.stage("sky") as note:
            open_sky = note(sky(self.sky, view.scene, gbuffer, view.seed))
        with profile.stage("shade"):
            reflected = lit.radiance + open_sky.radiance
            direct, indirect = gbuffer.emission + reflected, ambient_light(gbuffer, reflected, self.ambient)
        return direct, indirect


def ambient_light(gbuffer: _core.GBuffer, reflected: Image, multiple: float) -> Image:
    """What surfaces reflect of light that arrives from everywhere with a multiple of the mean radiance `reflected` of all that is seen."""
    seen = np.isfinite(gbuffer.depth)
    mean = reflected[seen].mean(0) if seen.any() else np.zeros(3, np.float32)
    light: Image = gbuffer.albedo * (multiple * mean).astype(np.float32) * seen[..., None]
    return light
