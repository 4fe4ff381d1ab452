"""Rehfeld's method as the paper sets it, and how far its light is from what it approximates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir

COUNTS = (1024, 2048, 4096, 8192)
RESOLUTIONS = (8, 16, 32)

Image = NDArray[np.floating[Any]]


def caching(**changes: Any) -> ir.methods.ClusteredRadianceCaching:
    """The preset with knobs replaced; `fill__resolution=8` is the knob fill.resolution."""
    method = ir.methods.ClusteredRadianceCaching.preset("Rehfeld 2014")
    return method.replace({name.replace("__", "."): value for name, value in changes.items()})


def own(resolution: int = 32) -> ir.methods.ClusteredRadianceCaching:
    """What sharing approximates: every pixel with a cache of its own, of the finest resolution that the paper tries."""
    return caching(interpolate=ir.Evaluated(), fill__resolution=resolution)


def indirect(records: ir.Records, index: int) -> Image:
    return np.asarray(records.images(records[index])[1])


def difference(image: Image, exact: Image) -> float:
    """Root of the mean squared difference over the mean of what is right: dark corners count as much as they are seen."""
    return float(np.sqrt(((image - exact) ** 2).mean()) / exact.mean())
