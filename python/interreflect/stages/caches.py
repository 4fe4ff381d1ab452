"""Stages of clustered radiance caches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from interreflect import _core
from interreflect.scenes.scene import Scene
from interreflect.stages.voxels import _several


def distribute(technique: Any, gbuffer: _core.GBuffer, scene: Scene, history: _core.CachePlaces | None = None) -> _core.CachePlaces:
    """Where radiance caches stand: `.position`, `.normal`, `.tile`, and `.cluster`, the cache of each pixel's cluster (height, width).

    history: the last frame's places, for ReuseCaches."""
    return _core.distribute(technique, gbuffer, scene.core, history)


def fill(
    technique: Any, places: _core.CachePlaces, pyramids: _core.Pyramid | Sequence[_core.Pyramid], scene: Scene, seed: int = 0
) -> _core.FilledCaches:
    """The radiance that arrives at every cache, as hemisphere maps: `.texels` (n, resolution, resolution, 4). pyramids: as `march`
    takes them."""
    return _core.fill(technique, places, _several(pyramids), scene.core, seed)


def preconvolve(technique: Any, filled: _core.FilledCaches) -> _core.ConvolvedCaches:
    """Caches ready for lobes of every width."""
    return _core.preconvolve(technique, filled)


def interpolate(
    technique: Any,
    caches: _core.ConvolvedCaches | None,
    gbuffer: _core.GBuffer,
    scene: Scene,
    pyramids: _core.Pyramid | Sequence[_core.Pyramid],
    fill: Any = None,
    preconvolve: Any = None,
    seed: int = 0,
) -> _core.CacheLight:
    """Light that pixels get from caches: `.gathered` and `.glossy`, as `march` and `glossy` return them, and `.weight`.

    fill, preconvolve, pyramids: how pixels that no cache serves get one of their own (None: ConeFill, MipChain). Evaluated gives one to
    every pixel; for it `caches` may be None."""
    by = _core.ConeFill() if fill is None else fill
    convolve = _core.MipChain() if preconvolve is None else preconvolve
    return _core.interpolate(technique, caches, gbuffer, scene.core, by, convolve, _several(pyramids), seed)
