"""Stages of virtual area lights."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from interreflect import _core
from interreflect.scenes.lights import DirectionalLight
from interreflect.scenes.scene import Scene


def light_maps(scene: Scene, size: int = 512, emitter_views: int = 16, environment: Sequence[DirectionalLight] = ()) -> _core.LightMaps:
    """Reflective shadow maps of all lights: `.maps`, each with `.position`, `.normal`, `.flux`, `.area` (size, size[, 3]).

    Every point, spot and directional light, all emitters together and the environment together have size x size texels. Emitters are
    seen from `emitter_views` points on them; `environment`: directional lights that stand for it (`directional_lights`)."""
    suns = [_core.DirectionalLight(light.direction, light.irradiance) for light in environment]
    return _core.light_maps(scene.core, size, emitter_views, suns)


def bounce_maps(scene: Scene, lights: _core.VirtualLights, size: int = 512) -> _core.LightMaps:
    """What virtual lights see, each of them over its hemisphere: maps of their next bounce, size x size texels together."""
    return _core.bounce_maps(scene.core, lights, size)


def join_lights(lights: Sequence[_core.VirtualLights]) -> _core.VirtualLights:
    """The lights of several bounces as one list, without their clusters."""
    return lights[0] if len(lights) == 1 else _core.join_lights(list(lights))


def sample_lights(technique: Any, maps: _core.LightMaps, seed: int = 0) -> _core.VirtualLights:
    """Texels of the maps that become virtual lights, or seeds of their clusters: `.position`, `.normal`, `.flux`, `.area`."""
    return _core.sample_lights(technique, maps, seed)


def cluster_lights(
    technique: Any, seeds: _core.VirtualLights, maps: _core.LightMaps, history: _core.VirtualLights | None = None, seed: int = 0
) -> _core.VirtualLights:
    """Virtual lights that each stand for several texels: `.cluster`, every texel's light, map by map. history: the last frame's
    lights. ValueError where all weights of KMeans are 0."""
    return _core.cluster_lights(technique, seeds, maps, history, seed)


def scatter_points(technique: Any, scene: Scene) -> _core.SurfacePoints:
    """Points of a scene's surface for the maps of its virtual lights; they move with their bodies."""
    return _core.scatter_points(technique, scene.core)


def shadow_lights(
    technique: Any, lights: _core.VirtualLights, scene: Scene, points: _core.SurfacePoints | None = None
) -> _core.LightShadows:
    """What virtual lights see. points: of `scatter_points`, or None: scattered now. ValueError for more maps than fit into 4096^2
    texels."""
    return _core.shadow_lights(technique, lights, scatter_points(technique, scene) if points is None else points, scene.core)


def shade_lights(
    technique: Any,
    lights: _core.VirtualLights,
    shadows: _core.LightShadows,
    gbuffer: _core.GBuffer,
    scene: Scene,
    filter_shadows: Any = None,
    share: Any = None,
    seed: int = 0,
) -> _core.VirtualLight:
    """What pixels get from virtual lights: `.gathered.irradiance` and `.glossy.radiance`.

    filter_shadows: how shadows are looked up (None: SimpleLookup). share: which lights each pixel does itself (None: all)."""
    by = _core.SimpleLookup() if filter_shadows is None else filter_shadows
    return _core.light_pixels(technique, by, _core.EveryPixel() if share is None else share, lights, shadows, gbuffer, scene.core, seed)
