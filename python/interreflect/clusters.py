"""Clusters of pixels as a picture: which pixels share a cache, and where it stands."""

from __future__ import annotations

import colorsys

import numpy as np
from numpy.typing import NDArray

from interreflect import _core

_NONE = np.uint32(2**32 - 1)  # data/caches.h, no_cache
_GOLDEN = (5**0.5 - 1) / 2  # its multiples spread numbers that follow each other over all hues
DOT = (0.05, 1.0, 0.1)


def cluster_view(places: _core.CachePlaces, background: NDArray[np.float32] | None = None, dots: bool = True) -> NDArray[np.float32]:
    """(height, width, 3) in [0, 1]: every cluster in a colour of its own, black where there is none; a green dot where each cache stands.

    background: (height, width, 3) in [0, 1], shown in place of the clusters. ValueError for one of another size.
    """
    cluster = places.cluster
    if background is not None and background.shape != (*cluster.shape, 3):
        raise ValueError(f"background must have the picture's shape {(*cluster.shape, 3)}, got {background.shape}")
    if background is None:
        hues = [colorsys.hsv_to_rgb(i * _GOLDEN % 1, 0.65, 0.55 + 0.45 * (i * _GOLDEN**2 % 1)) for i in range(len(places))]
        colours = np.array([*hues, (0.0, 0.0, 0.0)], np.float32)
        picture = colours[np.where(cluster == _NONE, len(places), cluster)]
    else:
        picture = np.array(background, np.float32)
    if dots:
        _draw_dots(picture, places.screen)
    return picture


def _draw_dots(picture: NDArray[np.float32], centres: NDArray[np.float32]) -> None:
    """Squares of about a three-hundredth of the picture's width."""
    height, width = picture.shape[:2]
    reach = max(0, round(width / 600))
    x, y = centres.astype(int).T
    for down in range(-reach, reach + 1):
        for right in range(-reach, reach + 1):
            picture[np.clip(y + down, 0, height - 1), np.clip(x + right, 0, width - 1)] = DOT
