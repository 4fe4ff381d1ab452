"""Stages of precomputed illuminance composition."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.scene import Scene
from interreflect.scenes.unwrap import unwrap


def place_surfels(technique: Any, scene: Scene) -> _core.Surfels:
    """Disks that stand for the scene's still surface: `.position`, `.normal` (n, 3), `.area` (n,). Bodies have none.

    They lie on the sides that see the front of something, where materials are two-sided on both; what is buried has none."""
    return _core.open_sides(_core.place_surfels(technique, scene.core), scene.core)


def cluster_surfels(technique: Any, surfels: _core.Surfels) -> _core.ClusteredSurfels:
    """A binary tree over surfels in post-order; `.surfels` come back in the order of its leaves."""
    return _core.cluster_surfels(technique, surfels)


def place_caches(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer | None = None, about: Scene | None = None
) -> _core.CacheSites:
    """Where caches of incident radiance stand: `.position`, `.normal` (n, 3). PixelCaches needs the picture: `gbuffer`. about: the scene
    whose box a grid fills, with bodies that `scene` may lack."""
    box = (scene if about is None else about).core
    if isinstance(technique, _core.PixelCaches):
        if gbuffer is None:
            raise ValueError("PixelCaches needs the picture whose pixels it stands at: place_caches(..., gbuffer=...)")
        return _core.pixel_sites(gbuffer)
    if isinstance(technique, _core.LightMap):
        return _core.place_caches(technique, scene.core, box, unwrap(scene, technique.texels, technique.area_share))
    return _core.place_caches(technique, scene.core, box)


def link(
    technique: Any, sites: _core.CacheSites, surfels: _core.ClusteredSurfels, scene: Scene
) -> _core.CacheLinks | _core.LinkCandidates | None:
    """Which patches of surfels send light to each cache; None for AllSurfels, which stores nothing. FluxLinks: what `_core.choose_links`
    takes every frame's from."""
    return None if isinstance(technique, _core.AllSurfels) else _core.link(technique, sites, surfels, scene.core)


def surfel_pixels(surfels: _core.ClusteredSurfels, scene: Scene) -> _core.GBuffer:
    """Surfels as the pixels of a picture, row by row, for `shadow`, `sky` and `evaluate`."""
    return _core.surfel_pixels(surfels, scene.core)


def pull(
    surfels: _core.ClusteredSurfels, radiance: NDArray[np.float32], radiosity: bool = False, packed: bool = False
) -> _core.NodeLight:
    """What every patch of surfels sends on: the sum of flux, or the mean radiosity. radiance: (..., 3) of each surfel. packed: in 4 bytes
    a patch in place of 12, rounded by at most a 512th of the largest colour."""
    return _core.pull(surfels, radiance, radiosity, packed)


def used_caches(sites: _core.CacheSites, gbuffer: _core.GBuffer) -> NDArray[np.uint8]:
    """(caches,): 1 where some pixel interpolates from the cache, else 0."""
    return _core.used_caches(sites, gbuffer)


def light_caches(
    technique: Any,
    links: _core.CacheLinks | None,
    sites: _core.CacheSites,
    surfels: _core.ClusteredSurfels,
    light: _core.NodeLight,
    scene: Scene,
    chrominance_bands: int = 0,
    seed: int = 0,
    window: str = "none",
    used: NDArray[np.uint8] | None = None,
) -> _core.LightCaches:
    """Incident radiance of every cache, in spherical harmonics: the sum over its links, or for AllSurfels over surfels themselves.

    window: none, hanning or lanczos, over the bands. used: caches that anything reads (`used_caches`); the others may stay black."""
    if links is None:
        made = _core.sample_caches(technique, sites, surfels, light, chrominance_bands, scene.core, seed, used)
    else:
        made = _core.light_caches(links, light, technique.bands, chrominance_bands, used)
    _core.window_caches(made, window)
    return made


def evaluate(
    technique: Any,
    caches: _core.LightCaches | None,
    sites: _core.CacheSites,
    gbuffer: _core.GBuffer,
    scene: Scene,
    links: _core.CacheLinks | _core.AllSurfels | None = None,
    light: _core.NodeLight | None = None,
    surfels: _core.ClusteredSurfels | None = None,
    seed: int = 0,
) -> _core.SurfelLight:
    """What pixels get from caches: `.gathered.irradiance` and `.glossy.radiance`. DirectLinks takes, in place of the caches' light, the
    links and what comes through them; of AllSurfels the surfels."""
    if isinstance(technique, _core.DirectLinks):
        if light is not None and surfels is not None and isinstance(links, _core.AllSurfels):
            return _core.evaluate(technique, links, sites, surfels, light, gbuffer, scene.core, seed)
        if light is None or not isinstance(links, _core.CacheLinks):
            raise ValueError("DirectLinks needs links, or AllSurfels and surfels, and what they send: evaluate(..., links=..., light=...)")
        return _core.evaluate(technique, links, light, sites, gbuffer, scene.core)
    if caches is None:
        raise ValueError(f"{type(technique).__name__} needs the caches' light")
    return _core.evaluate(technique, caches, sites, gbuffer, scene.core)
