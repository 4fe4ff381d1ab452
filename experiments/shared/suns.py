"""Ten suns sampled from the image of a sky: the light of Rehfeld et al.'s pictures."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from experiments.shared.placed import turned
from experiments.shared.scenes import load

SUNS = 10
TILT = 60.0  # degrees


def sky(suns: int = SUNS) -> tuple[ir.DirectionalLight, ...]:
    """The courtyard's image as so many suns. Its light comes in low, between 5 and 40 degrees, and would end on the upper arches: the
    image is tilted until it falls on floor and cars, three quarters and two fifths of which it then reaches."""
    (courtyard,) = (light for light in load("bmw_m6/scene.toml").lights if isinstance(light, ir.EnvironmentLight))
    image = _tilted(np.asarray(courtyard.image), TILT)
    return ir.directional_lights(dataclasses.replace(courtyard, image=image), suns)


def _tilted(image: NDArray[np.float32], degrees: float) -> NDArray[np.float32]:
    """A latitude-longitude image whose centre, at -z, has gone up; nearest texels."""
    height, width = image.shape[:2]
    polar = ((np.arange(height) + 0.5) * np.pi / height)[:, None]
    azimuth = (np.arange(width) + 0.5) * 2 * np.pi / width - np.pi
    towards = np.stack(np.broadcast_arrays(np.sin(polar) * np.sin(azimuth), np.cos(polar), -np.sin(polar) * np.cos(azimuth)), 2)
    x, y, z = np.moveaxis(towards @ turned(degrees, (1, 0, 0)), 2, 0)  # times the transpose: where it was
    rows = np.minimum((np.arccos(np.clip(y, -1, 1)) / np.pi * height).astype(int), height - 1)
    columns = ((np.arctan2(x, -z) / (2 * np.pi) + 0.5) * width).astype(int) % width
    return np.ascontiguousarray(image[rows, columns])
