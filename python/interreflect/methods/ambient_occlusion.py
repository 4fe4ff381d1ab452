"""Ambient occlusion in screen space: constant ambient light, less beside what the camera sees nearby."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.constant_ambient import ambient_light
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import shadow, sky, trace_gbuffer

GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))
BIAS = 0.01  # of the radius: a neighbour must stand so far above the tangent plane to count, lest rounding does
SOFTENING = 0.01  # of the squared radius: keeps the sum finite where a neighbour is all but here


@method
class AmbientOcclusion(Method):
    """`ConstantAmbient` times the obscurance of McGuire et al. 2011, equation 10, with exponent 1 and unfiltered.

    Surfaces nearer than `radius` that the camera sees above a pixel's tangent plane take ambient light away; what it does not see, not.
    """

    ambient: float = knob(default=1.0, doc="indirect light as a multiple of the mean reflected direct light", minimum=0.0)
    radius: float = knob(default=0.1, doc="how far surfaces occlude", unit="extents", minimum=0.0, maximum=1.0, open_minimum=True)
    samples: int = knob(default=16, doc="neighbours that each pixel looks at", unit="samples", minimum=1, maximum=256)
    strength: float = knob(default=1.0, doc="multiple of the obscurance", minimum=0.0)
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.TracedSky())

    bounces = 1

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(view.scene, view.camera, view.size))
        with profile.stage("occlusion"):
            extent = float(np.ptp(np.asarray(view.scene.bounds), axis=0).max())
            is_open = unobscured(gbuffer, view, self.radius * extent, self.samples, self.strength)
        with profile.stage("shadow") as note:
            lit = note(shadow(self.shadow, view.scene, gbuffer, view.seed))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, view.scene, gbuffer, view.seed))
        with profile.stage("shade"):
            reflected = lit.radiance + environment.radiance
            direct = gbuffer.emission + reflected
            indirect = ambient_light(gbuffer, reflected, self.ambient) * is_open[..., None]
        return direct, indirect


def unobscured(gbuffer: _core.GBuffer, view: View, radius: float, samples: int, strength: float) -> Image:
    """The share of ambient light that each pixel keeps, (height, width), in [0, 1]; radius in scene units."""
    height, width = gbuffer.depth.shape
    seen = np.isfinite(gbuffer.depth)
    position = np.where(seen[..., None], gbuffer.position, np.float32(0))
    depth = np.where(seen, np.linalg.norm(position - np.asarray(view.camera.position, np.float32), axis=2), np.inf)
    pixels = radius * width / (2 * math.tan(math.radians(view.camera.fov_x) / 2)) / np.maximum(depth, 1e-3 * radius)
    reach = np.minimum(pixels, max(height, width) / 4).astype(np.float32)
    turn = np.random.default_rng(view.seed).random((height, width), np.float32) * np.float32(2 * math.pi)
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    total = np.zeros((height, width), np.float32)
    for index in range(samples):
        angle, distance = turn + np.float32(index * GOLDEN_ANGLE), reach * np.float32((index + 0.5) / samples)
        y = np.clip(np.rint(rows + distance * np.sin(angle)), 0, height - 1).astype(np.intp)
        x = np.clip(np.rint(columns + distance * np.cos(angle)), 0, width - 1).astype(np.intp)
        towards = (position[y, x] - position) / np.float32(radius)
        square = np.einsum("ijk,ijk->ij", towards, towards)
        above = np.maximum(np.einsum("ijk,ijk->ij", towards, gbuffer.normal) - np.float32(BIAS), 0)
        total += np.where((square < 1) & seen[y, x], above / (square + np.float32(SOFTENING)), 0)
    share: Image = np.clip(1 - np.float32(2 * strength / samples) * total, 0, 1) * seen
    return share
