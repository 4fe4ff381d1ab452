"""Ways to one bounce of indirect light that precompute nothing, at settings from milliseconds to seconds."""

from __future__ import annotations

from typing import Any

import interreflect as ir
from experiments.shared.contenders import SMOOTH_SKY


def rivals() -> list[Any]:
    """Each way's knobs that trade time for error."""
    cones, caches = ir.methods.VoxelConeTracing(), ir.methods.ClusteredRadianceCaching()
    lights = ir.methods.VirtualAreaLights(sky=SMOOTH_SKY)
    maps = {"shadow_lights": ir.ImperfectShadowMaps(), "filter_shadows": ir.Pcss()}
    ways: list[tuple[int, dict[str, Any]]] = [
        *((n, {"filter_shadows": ir.TracedDisk(samples=1)}) for n in (16, 64, 256, 512)),
        (512, {}),
        *((n, maps) for n in (64, 512)),
        (64, maps | {"filter_shadows": ir.SimpleLookup()}),
    ]
    return [
        *ir.sweep(cones, {"grid.resolution": [64, 128]}),
        cones.replace(share=ir.EveryPixel()),
        *ir.sweep(caches, {"distribute.caches": [512, 2048, 4096]}),
        *(lights.replace({"sample_lights.lights": n}).replace(way) for n, way in ways),
    ]
