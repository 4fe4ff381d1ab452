"""Configurations of voxel cone tracing that papers describe: values of its fields and nothing else.

Where the thesis is silent its author's program is followed, else our defaults. What stages correct of printed equations stays corrected.
"""

from __future__ import annotations

from typing import Any

from interreflect import _core

# Listing 4.1: its `bias`, `coneHeight`, `lodOffset` and `steps` as the program sets them, its end at alpha .95, its step of a radius.
LISTING: dict[str, Any] = {
    "normal_offset": 1.0, "start": "height", "level_bias": 0.1, "most_steps": 16, "cut_off": 0.05, "step": 0.5,
    "density": 1.0, "correlation": 0.0, "own_surface": True, "multiply_by_occlusion": True,
}  # fmt: skip

FREED_2018: dict[str, Any] = {
    "grid": _core.Grid(resolution=256, warp=_core.CubicSpline(alpha=0.25)),
    "voxelize": _core.Tessellation(spacing=1.0, split=False),
    "light_voxels": _core.ShadowMapInjection(size=4096),
    "prefilter": _core.VolumeCoverage(levels=6),
    "march": _core.DiffuseCones(set="freed_thesis", start_height=1.0, **LISTING),
    "glossy": _core.GlossyCone(aperture="freed", start_height=5.0, **LISTING),
    "share": _core.EveryPixel(),
    "shade": _core.FreedCookTorrance(),
    "shadow": _core.ShadowMap(size=4096),
    # The thesis has no environment. Its filter leaks, and cones would let a sky in that it never had: rays see the sky instead.
    "sky": _core.TracedSky(),
}

# Section 4: a texel as wide as the cone, half its diameter a step, three quarters of a voxel at the start, half a step off it.
STEPS: dict[str, Any] = {"step": 0.5, "first_diameter": 0.75, "level_bias": 0.0, "density": 1.0, "correlation": 0.0}

REHFELD_2014_VOXELS: dict[str, Any] = {
    "grid": _core.Grid(resolution=128),
    "voxelize": _core.SurfaceSampling(),
    "light_voxels": _core.ConeLighting(step=0.5),
    "prefilter": _core.SurfaceCoverage(),
    "march": _core.DiffuseCones(**STEPS),
    "glossy": _core.GlossyCone(**STEPS),
    "share": _core.EveryPixel(),
}

PRESETS = {"Freed 2018": FREED_2018, "Rehfeld 2014 voxels": REHFELD_2014_VOXELS}
