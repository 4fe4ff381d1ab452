"""Jendersie's two settings as knobs of IlluminanceComposition [Jendersie et al. 2016, table 2]."""

from __future__ import annotations

from typing import Any

from interreflect import _core

PAPER: dict[str, Any] = {"bounces": None, "cluster_surfels": _core.Agglomerative(normal_weight=0.1, balance_weight=0.02)}
# A light map of 128 x 128 and a grid of 24 x 8 x 12, as in 5.3.4; the paper does not say how many rays it sent to a surfel, and it has no
# rays to what is near (near_rays), nor does it look before surfaces (normal_offset).
CACHES = _core.LightMap(texels=128, grid=_core.CacheGrid(nx=24, ny=8, nz=12, normal_offset=0.0))

PRESETS: dict[str, dict[str, Any]] = {
    "setting 1": {
        **PAPER,
        "place_surfels": _core.RelaxedSurfels(surfels=131072),
        "place_caches": CACHES,
        "link": _core.ShLinks(links=254, bands=4, near_rays=0),
    },
    "setting 2": {
        **PAPER,
        "place_surfels": _core.RelaxedSurfels(surfels=32768),
        "place_caches": CACHES,
        "link": _core.ShLinks(links=128, bands=3, near_rays=0),
    },
}
