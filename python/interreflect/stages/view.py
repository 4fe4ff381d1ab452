"""Stages that every method has: what the camera sees, and the light that comes without a detour."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.camera import Camera, checked_size
from interreflect.scenes.scene import Scene


def camera_of(scene: Scene, camera: Camera | str | None) -> Camera:
    """The camera itself, the scene's camera of that name, or its first. KeyError-like ValueError names those there are."""
    if isinstance(camera, Camera):
        return camera
    if camera is None:
        return scene.camera
    if camera in scene.cameras:
        return scene.cameras[camera]
    raise ValueError(f"scene {scene.name!r} has no camera {camera!r}; it has {', '.join(scene.cameras) or 'none'}")


def core_camera(camera: Camera) -> _core.Camera:
    return _core.Camera(camera.position, camera.target, camera.up, camera.fov_x)


def trace_gbuffer(
    scene: Scene, camera: Camera | str | None = None, size: tuple[int, int] | None = None, shade: Any = None
) -> _core.GBuffer:
    """What the camera sees through pixel centres: position, normal, albedo, ... as (height, width, ...) views, no copies.

    shade: the technique by which its surfaces reflect in `shadow`, `sky`, `glossy` and `shade`; None: Exact.
    """
    view = camera_of(scene, camera)
    width, height = view.size if size is None else checked_size(size)
    return _core.trace_gbuffer(scene.core, core_camera(view), width, height, _core.Exact() if shade is None else shade)


def shadow_maps(technique: Any, scene: Scene) -> _core.ShadowMaps | None:
    """Depth seen from every point, spot and directional light, which all that they light can share; None but for ShadowMap."""
    return _core.shadow_maps(technique, scene.core) if isinstance(technique, _core.ShadowMap) else None


def shadow(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, pyramids: Sequence[_core.Pyramid] = (),
    maps: _core.ShadowMaps | None = None,
) -> _core.DirectLight:  # fmt: skip
    """Light of point, spot and directional lights and of emitters, reflected once at the pixels: `.radiance` (height, width, 3).
    VoxelCones needs the voxels' pyramids; what several let through is multiplied. maps: of `shadow_maps`; None: ShadowMap makes its own."""
    if isinstance(technique, _core.VoxelCones):
        if not pyramids:
            raise ValueError("VoxelCones needs the voxels to march through: shadow(..., pyramids=[prefilter(...)])")
        return _core.cone_shadow(technique, scene.core, gbuffer, list(pyramids), seed)
    if maps is not None:
        return _core.shadow(technique, scene.core, gbuffer, maps, seed)
    return _core.shadow(technique, scene.core, gbuffer, seed)


def lamp_shadow(
    technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, maps: _core.ShadowMaps | None = None
) -> _core.DirectLight:
    """`shadow` without emitters: what point, spot and directional lights send alone."""
    if maps is not None:
        return _core.lamp_shadow(technique, scene.core, gbuffer, maps, seed)
    return _core.lamp_shadow(technique, scene.core, gbuffer, seed)


def sky(technique: Any, scene: Scene, gbuffer: _core.GBuffer, seed: int = 0, gathered: Any = None, glossy: Any = None) -> _core.DirectLight:
    """Light of the environment, reflected once at the pixels. ConeSky takes it from what the march's cones left open:
    `gathered` and `glossy`."""
    if isinstance(technique, _core.ConeSky):
        if gathered is None:
            raise ValueError("ConeSky needs what the march gathered: sky(..., gathered=march(...))")
        return _core.cone_sky(gbuffer, gathered, glossy)
    return _core.sky(technique, scene.core, gbuffer, seed)


def shade(gbuffer: _core.GBuffer, light: _core.GatheredLight, glossy: _core.GlossyLight | None = None) -> NDArray[np.float32]:
    """(height, width, 3): indirect light that leaves the pixels' surfaces towards the camera."""
    return _core.shade(gbuffer, light, glossy)
