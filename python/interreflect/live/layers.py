"""What a page can show of a frame: its light, the surfaces, and what the method's stages made of the scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.clusters import cluster_view, light_cluster_view
from interreflect.cubes import voxel_view
from interreflect.images import tone_map
from interreflect.live import points, sheets
from interreflect.live.seen import Seen
from interreflect.stages import shadow_maps, trace_gbuffer

Bytes = NDArray[np.uint8]
Floats = NDArray[np.float32]
CURVE = "reinhard"


@dataclass(frozen=True)
class Layer:
    """stages: whose results it draws. draw: (height, width, 3) bytes of what was seen, at an exposure in stops; ValueError where the
    method makes nothing of the kind."""

    stages: tuple[str, ...]
    draw: Callable[[Seen, float], Bytes]


def light(radiance: Floats, exposure: float) -> Bytes:
    """Radiance as every layer of light shows it."""
    return tone_map(radiance, exposure, CURVE)


def _albedo(seen: Seen, exposure: float) -> Bytes:
    return tone_map(_gbuffer(seen).albedo)


def _normals(seen: Seen, exposure: float) -> Bytes:
    gbuffer = _gbuffer(seen)
    hit = np.isfinite(gbuffer.depth)[..., None]
    return _bytes(np.where(hit, 0.5 + 0.5 * gbuffer.normal, 0))


def _voxels(seen: Seen, exposure: float) -> Bytes:
    return tone_map(_cubes(seen, "voxelize"))


def _lit_voxels(seen: Seen, exposure: float) -> Bytes:
    return light(_cubes(seen, "light_voxels"), exposure)


def _cubes(seen: Seen, stage: str) -> Floats:
    """The nearest of the voxels that a stage made, of all parts of the scene."""
    parts = [one for one in seen.results[stage] if isinstance(one, (_core.VoxelGrid, _core.LitVoxels))]
    if not parts:
        raise _nothing(seen, "voxels")
    views = [voxel_view(part, seen.camera, seen.size) for part in parts]
    nearest = np.argmin([view.depth for view in views], 0)
    image: Floats = np.take_along_axis(np.stack([view.image for view in views]), nearest[None, ..., None], 0)[0]
    return image


def _caches(seen: Seen, exposure: float) -> Bytes:
    background = light(seen.frame.image, exposure)
    places = seen.first("distribute")
    if isinstance(places, _core.CachePlaces):
        x, y = places.screen.astype(int).T
        points.mark(background, x, y)
        return background
    sites = seen.prepared.state.get("sites") or seen.first("place_caches")
    if sites is None:
        raise _nothing(seen, "caches")
    return points.dots(background, np.asarray(sites.position), _gbuffer(seen).depth, seen.camera)


def _surfels(seen: Seen, exposure: float) -> Bytes:
    return points.surfel_disks(_surfels_of(seen, "surfels"), _gbuffer(seen))


def _clusters(seen: Seen, exposure: float) -> Bytes:
    places, lights = seen.first("distribute"), seen.first("cluster_lights")
    if isinstance(places, _core.CachePlaces):
        return _bytes(cluster_view(places, dots=False))
    if lights is not None:
        return sheets.fitted(_bytes(light_cluster_view(lights, seen.first("reflective_shadow_maps"), dots=False)), seen.size)
    tree = _surfels_of(seen, "clusters")
    if not isinstance(tree, _core.ClusteredSurfels):
        raise _nothing(seen, "clusters")
    return points.surfel_clusters(tree, _gbuffer(seen))


def _surfels_of(seen: Seen, what: str) -> Any:
    surfels = seen.prepared.state.get("surfels")
    if surfels is None:
        raise _nothing(seen, what)
    return surfels


def _shadow_maps(seen: Seen, exposure: float) -> Bytes:
    """Of lights where the method has such, else of virtual lights."""
    technique = getattr(seen.prepared.method, "shadow", None)
    if isinstance(technique, _core.ShadowMap):
        depths = list(shadow_maps(technique, seen.prepared.scene).depth)  # type: ignore[union-attr]
    else:
        virtual = seen.first("shadow_lights")
        depths = [] if virtual is None else list(virtual.depth)
    if not depths:
        raise _nothing(seen, "shadow maps")
    return sheets.depth_sheet(depths, seen.size)


def _light_maps(seen: Seen, exposure: float) -> Bytes:
    """Flux that texels send on; each map as bright as the next."""
    maps = seen.first("reflective_shadow_maps")
    if maps is None:
        raise _nothing(seen, "light maps")
    return sheets.flux_sheet([np.asarray(one.flux) for one in maps.maps], seen.size)


def _gbuffer(seen: Seen) -> Any:
    found = seen.first("gbuffer")
    return trace_gbuffer(seen.prepared.scene, seen.camera, seen.size) if found is None else found


def _nothing(seen: Seen, what: str) -> ValueError:
    return ValueError(f"{seen.prepared.method.name} makes no {what} as it is set")


def _bytes(unit: NDArray[np.floating]) -> Bytes:
    rounded: Bytes = np.round(255 * np.clip(unit, 0, 1)).astype(np.uint8)
    return rounded


LAYERS = {
    "image": Layer((), lambda seen, exposure: light(seen.frame.image, exposure)),
    "direct": Layer((), lambda seen, exposure: light(seen.frame.direct, exposure)),
    "indirect": Layer((), lambda seen, exposure: light(seen.frame.indirect, exposure)),
    "albedo": Layer(("gbuffer",), _albedo),
    "normals": Layer(("gbuffer",), _normals),
    "voxels": Layer(("voxelize",), _voxels),
    "lit voxels": Layer(("light_voxels",), _lit_voxels),
    "caches": Layer(("gbuffer", "distribute", "place_caches"), _caches),
    "surfels": Layer(("gbuffer",), _surfels),
    "clusters": Layer(("gbuffer", "distribute", "cluster_lights", "reflective_shadow_maps"), _clusters),
    "shadow maps": Layer(("shadow_lights",), _shadow_maps),
    "light maps": Layer(("reflective_shadow_maps",), _light_maps),
}
