"""Rehfeld's method, and the studies of its figures on the two cars."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from experiments.shared.keep import NONE
from experiments.shared.two_cars import EXPONENT, two_cars

SMALL = (872, 572)  # half the paper's pictures along each side
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


def cars(
    name: str, methods: Sequence[Any], exponent: float = EXPONENT, camera: str = "cars", size: tuple[int, int] = SMALL,
    reference: ir.Reference = NONE, repeats: int = 0,
) -> ir.Study:  # fmt: skip
    """Pictures of the cars; not timed unless `repeats` says so."""
    return ir.Study(
        name=f"Rehfeld: {name}, exponent {exponent:g}", scenes=[two_cars(exponent)], cameras=[camera], methods=methods, size=size,
        bounces=1, reference=reference, repeats=repeats, max_repeats=max(repeats, 1),
    )  # fmt: skip


def indirect(records: ir.Records, index: int) -> Image:
    return np.asarray(records.images(records[index])[1])


def difference(image: Image, exact: Image) -> float:
    """Root of the mean squared difference over the mean of what is right: dark corners count as much as they are seen."""
    return float(np.sqrt(((image - exact) ** 2).mean()) / exact.mean())
