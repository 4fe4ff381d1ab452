"""Clusters as pictures: which pixels share a cache, which texels of a light's map share a virtual light, and where these stand."""

from __future__ import annotations

import colorsys

import numpy as np
from numpy.typing import NDArray

from interreflect import _core

_NONE = np.uint32(2**32 - 1)  # data/caches.h, no_cache; data/virtual_lights.h, no_virtual_light
_GOLDEN = (5**0.5 - 1) / 2  # its multiples spread numbers that follow each other over all hues
DOT = (0.05, 1.0, 0.1)


def cluster_view(places: _core.CachePlaces, background: NDArray[np.float32] | None = None, dots: bool = True) -> NDArray[np.float32]:
    """(height, width, 3) in [0, 1]: every cluster in a colour of its own, black where there is none; a green dot where each cache stands.

    background: (height, width, 3) in [0, 1], shown in place of the clusters. ValueError for one of another size.
    """
    picture = _picture(places.cluster.shape, places.cluster, len(places), background)
    if dots:
        _draw_dots(picture, places.screen)
    return picture


def light_cluster_view(
    lights: _core.VirtualLights, maps: _core.LightMaps, number: int = 0, background: NDArray[np.float32] | None = None, dots: bool = True
) -> NDArray[np.float32]:
    """(size, size, 3) in [0, 1], of map `number`: every cluster of texels in a colour of its own, black where nothing is sent on or nothing
    was clustered; a green dot where each light stands. maps: those that the lights come from.

    background: (size, size, 3) in [0, 1], shown in place of the clusters. ValueError for one of another size or a map that is not there.
    """
    sizes = [len(one.area) for one in maps.maps]
    if not 0 <= number < len(sizes):
        raise ValueError(f"number must be that of one of {len(sizes)} maps, got {number}")
    size, first = sizes[number], sum(side * side for side in sizes[:number])
    cluster = lights.cluster[number] if lights.cluster else None
    picture = _picture((size, size), cluster, len(lights), background)
    texel = lights.texel[lights.flux.max(1, initial=0) > 0].astype(np.int64) - first
    texel = texel[(texel >= 0) & (texel < size * size)]
    if dots:
        _draw_dots(picture, np.stack((texel % size, texel // size), 1))
    return picture


def _picture(
    shape: tuple[int, ...], cluster: NDArray[np.uint32] | None, count: int, background: NDArray[np.float32] | None
) -> NDArray[np.float32]:
    """A copy of the background, or every cluster in its colour."""
    if background is not None and background.shape != (*shape, 3):
        raise ValueError(f"background must have the picture's shape {(*shape, 3)}, got {background.shape}")
    if background is not None:
        return np.array(background, np.float32)
    if cluster is None:
        return np.zeros((*shape, 3), np.float32)
    colours = np.concatenate((number_colours(count), np.zeros((1, 3), np.float32)))
    return np.asarray(colours[np.where(cluster == _NONE, count, cluster)])


def number_colours(count: int) -> NDArray[np.float32]:
    """(count, 3) in [0, 1]: a colour for each number; those that follow each other differ most."""
    hues = [colorsys.hsv_to_rgb(i * _GOLDEN % 1, 0.65, 0.55 + 0.45 * (i * _GOLDEN**2 % 1)) for i in range(count)]
    return np.array(hues, np.float32).reshape(count, 3)


def _draw_dots(picture: NDArray[np.float32], centres: NDArray[np.floating] | NDArray[np.integer]) -> None:
    """Squares of about a three-hundredth of the picture's width."""
    height, width = picture.shape[:2]
    reach = max(0, round(width / 600))
    x, y = centres.astype(int).T
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            picture[np.clip(y + down, 0, height - 1), np.clip(x + right, 0, width - 1)] = DOT
