"""Four ways to one bounce of indirect light at settings from milliseconds to seconds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import interreflect as ir
from experiments.shared.scenes import sponza, sponza_by_a_spot, veach_ajar
from interreflect.study.ladder import Mechanism, mechanisms

PAPERS = ("64 with PCSS", "512 simple", "256 points", "128 area lights")


BLACK = "direct light alone"
SMOOTH_SKY = ir.TracedSky(samples=16, filter_radius=2)  # the sky's direct light is not what is compared: cones have it without noise


def rivals() -> dict[str, Any]:
    """Each way's knobs that trade time for error; and direct light alone, which no way may lose against."""
    cones, caches = ir.methods.VoxelConeTracing(), ir.methods.ClusteredRadianceCaching()
    lights = ir.methods.VirtualAreaLights(sky=SMOOTH_SKY)
    maps = {"shadow_lights": ir.ImperfectShadowMaps(), "filter_shadows": ir.Pcss()}
    ways: dict[str, tuple[int, dict[str, Any]]] = {
        **{f"{n} lights, a ray each": (n, {"filter_shadows": ir.TracedDisk(samples=1)}) for n in (16, 64, 256, 512)},
        "512 lights, 4 rays each": (512, {}),
        **{f"{n} lights, PCSS": (n, maps) for n in (64, 512)},
        "64 lights, simple": (64, maps | {"filter_shadows": ir.SimpleLookup()}),
    }
    return {
        BLACK: ir.methods.ConstantAmbient(ambient=0.0, sky=SMOOTH_SKY),
        **{f"cones, grid {n}, interleaved": cones.replace({"grid.resolution": n}) for n in (64, 128)},
        "cones, grid 128": cones.replace(share=ir.EveryPixel()),
        **{f"{n} caches": caches.replace({"distribute.caches": n}) for n in (512, 2048, 4096)},
        **{name: lights.replace({"sample_lights.lights": n}).replace(way) for name, (n, way) in ways.items()},
        **{f"the paper's {name}": ir.methods.VirtualAreaLights.preset(name).replace(sky=SMOOTH_SKY) for name in PAPERS},
        **{f"denoised paths, {n} a pixel": ir.methods.PathTracingDenoised(bounces=1, spp=n) for n in (1, 2, 4, 16)},
    }
