"""The paper's configurations as methods, its scene, and the studies that its figures are drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from experiments.shared.keep import NONE, QUALITY, SIZE

FULL = (1280, 720)  # the paper's pictures
SMALL = (320, 180)  # where a truth with little noise is wanted, or many rays
MAP = (512, 512)  # a light's map, a pixel a texel

CLEAN = ir.Reference(noise=2e-3, max_spp=2048)  # at SMALL: 40 s of paths

Image = NDArray[np.floating[Any]]


@cache
def scene() -> ir.Scene:
    return ir.scenes.cornell_box(light="spot", box="glossy")


def area_lights(preset: str = "64 with PCSS", **changes: Any) -> ir.methods.VirtualAreaLights:
    """A preset with knobs replaced; `sample_lights__lights=64` is the knob sample_lights.lights."""
    return replaced(ir.methods.VirtualAreaLights.preset(preset), **changes)


def replaced(method: Any, **changes: Any) -> Any:
    return method.replace({name.replace("__", "."): value for name, value in changes.items()})


def study(
    name: str, methods: Sequence[Any], at: ir.Scene | None = None, camera: str | None = None, size: tuple[int, int] = SIZE,
    reference: ir.Reference = NONE, repeats: int = 0, images: bool = True,
) -> ir.Study:  # fmt: skip
    """Pictures of the paper's scene, or of another; not timed unless `repeats` says so."""
    return ir.Study(
        name=f"Weinzierl-Heigl: {name}", scenes=[at or scene()], cameras=[camera] if camera else None, methods=methods, size=size,
        bounces=1, reference=reference, repeats=repeats, max_repeats=2 * max(repeats, 1), images=images,
    )  # fmt: skip


def compared(name: str, methods: Sequence[Any], **how: Any) -> ir.Study:
    """Beside the truth of one bounce."""
    return study(name, methods, **{"reference": QUALITY, **how})


def indirect(records: ir.Records, index: int) -> Image:
    return np.asarray(records.images(records[index])[1])


def difference(image: Image, exact: Image) -> float:
    """Root of the mean squared difference over the mean of what is right."""
    return float(np.sqrt(((image - exact) ** 2).mean()) / exact.mean())


def milliseconds(records: ir.Records, index: int, stages: Sequence[str]) -> float:
    """Of these stages together, of one record."""
    return sum(float(records[index].stages[stage]["milliseconds"]) for stage in stages if stage in records[index].stages)
