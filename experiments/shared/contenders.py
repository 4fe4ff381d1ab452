"""Every method and baseline at settings from milliseconds to seconds: who meets in a head to head."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import interreflect as ir

BLACK = "direct light alone"
PAPERS = "the paper's "
SMOOTH_SKY = ir.TracedSky(samples=16, filter_radius=2)  # the sky's direct light is not what is compared: cones have it without noise
BOUNCES = 3  # of virtual lights where all bounces are wanted


def contenders(bounces: int | None) -> Mapping[str, Any]:
    """By name, from `bounces` of light to compare with (1, or None for all): a method that can holds as many."""
    return {
        BLACK: ir.methods.ConstantAmbient(ambient=0.0, sky=SMOOTH_SKY),
        "constant ambient": ir.methods.ConstantAmbient(sky=SMOOTH_SKY),
        "ambient occlusion": ir.methods.AmbientOcclusion(sky=SMOOTH_SKY),
        **_cones(bounces),
        **_caches(bounces),
        **_virtual_lights(bounces),
        **_composition(bounces),
        **{f"light volumes, {n}": ir.methods.LightPropagationVolumes(grid=ir.Grid(resolution=n), sky=SMOOTH_SKY) for n in (32, 64)},
        **{f"denoised paths, {n} a pixel": ir.methods.PathTracingDenoised(bounces=bounces, spp=n) for n in (1, 2, 4, 16)},
        **{f"paths, {n} a pixel": ir.methods.PathTracing(bounces=bounces, spp=n) for n in (1, 4, 16)},
    }


def _lighting(bounces: int | None) -> dict[str, Any]:
    """Voxels hold all bounces after some frames of a motion; a first frame has one."""
    own = ir.TracedLighting(both_sides=True)
    return {"light_voxels": own if bounces == 1 else ir.Bounces(light_voxels=own)}


def _cones(bounces: int | None) -> dict[str, Any]:
    cones = ir.methods.VoxelConeTracing(**_lighting(bounces))
    return {
        **{f"cones, grid {n}, interleaved": cones.replace({"grid.resolution": n}) for n in (32, 64, 128)},
        "cones, grid 128": cones.replace(share=ir.EveryPixel()),
        **{f"{PAPERS}{name}": ir.methods.VoxelConeTracing.preset(name) for name in ("Freed 2018", "Rehfeld 2014 voxels")},
    }


def _caches(bounces: int | None) -> dict[str, Any]:
    caches = ir.methods.ClusteredRadianceCaching(**_lighting(bounces))
    return {
        **{f"{n} caches": caches.replace({"distribute.caches": n}) for n in (512, 2048)},
        f"{PAPERS}Rehfeld 2014": ir.methods.ClusteredRadianceCaching.preset("Rehfeld 2014"),
    }


def _virtual_lights(bounces: int | None) -> dict[str, Any]:
    lights = ir.methods.VirtualAreaLights(sky=SMOOTH_SKY, bounces=BOUNCES if bounces is None else bounces)
    one_ray = {"filter_shadows": ir.TracedDisk(samples=1)}
    return {
        **{f"{n} lights, a ray each": lights.replace({"sample_lights.lights": n, **one_ray}) for n in (16, 64, 256)},
        "512 lights, 4 rays each": lights.replace({"sample_lights.lights": 512}),
        **{f"{PAPERS}{name}": ir.methods.VirtualAreaLights.preset(name).replace(sky=SMOOTH_SKY) for name in ("64 with PCSS", "512 simple")},
    }


def _composition(bounces: int | None) -> dict[str, Any]:
    """The paper's two settings, and ours: fewer links with rays to what is near, looked up before surfaces."""
    papers = {name: ir.methods.IlluminanceComposition.preset(name) for name in ("setting 1", "setting 2")}
    ours = ir.methods.IlluminanceComposition(bounces=bounces)
    return {
        "composition": ours.replace(sky=SMOOTH_SKY),
        **{f"{PAPERS}{name}": setting.replace(bounces=bounces, sky=SMOOTH_SKY) for name, setting in papers.items()},
    }
