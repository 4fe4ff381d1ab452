"""Configurations of clustered radiance caching that the paper describes: values of its fields and nothing else."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.methods.voxel_presets import REHFELD_2014_VOXELS, STEPS

# Sections 4 and 5: 4,096 caches of 16 x 16 texels, gathered over two tiles, from 128^3 voxels lit with shadow cones.
REHFELD_2014: dict[str, Any] = {
    **{name: REHFELD_2014_VOXELS[name] for name in ("grid", "voxelize", "light_voxels", "prefilter")},
    "distribute": _core.Clustered(caches=4096, exponent=8.0),
    "fill": _core.ConeFill(resolution=16, normal_offset=1.5, **STEPS),
    "preconvolve": _core.MipChain(width="one_percent", level_bias=0.0),
    "interpolate": _core.Gather(radius=2.0),
}

PRESETS = {"Rehfeld 2014": REHFELD_2014}
