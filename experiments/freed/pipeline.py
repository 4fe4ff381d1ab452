"""Freed's program as a method, and the studies that his figures are drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import interreflect as ir
from experiments.shared.keep import NONE, QUALITY, SIZE
from experiments.shared.scenes import sponza


def freed(**changes: Any) -> ir.methods.VoxelConeTracing:
    """The preset with knobs replaced; `grid__resolution=64` is the knob grid.resolution. The grid is not warped unless a change says so."""
    method = ir.methods.VoxelConeTracing.preset("Freed 2018").replace({"grid.warp": ir.Linear()})
    return method.replace({name.replace("__", "."): value for name, value in changes.items()})


def drawn(name: str, methods: Sequence[Any], scene: ir.Scene | None = None, size: tuple[int, int] = SIZE) -> ir.Study:
    """Pictures of something that is not light, or that no truth is needed for."""
    return ir.Study(
        name=f"Freed: {name}",
        scenes=[scene or sponza()],
        cameras=["nave"],
        methods=methods,
        size=size,
        bounces=0,
        reference=NONE,
        repeats=0,
    )


def compared(name: str, methods: Sequence[Any], scene: ir.Scene | None = None, size: tuple[int, int] = SIZE) -> ir.Study:
    """Pictures beside the truth of one bounce; not timed. The thesis has no sky: here it is traced, lest cones that end early show it, by
    samples enough that its noise is not what one sees."""
    methods = [method.replace({"sky": ir.TracedSky(samples=64)}) for method in methods]
    return ir.Study(
        name=f"Freed: {name}",
        scenes=[scene or sponza()],
        cameras=["nave"],
        methods=methods,
        size=size,
        bounces=1,
        reference=QUALITY,
        repeats=0,
    )


def timed(name: str, methods: Sequence[Any], size: tuple[int, int]) -> ir.Study:
    """Times alone: medians of a few frames."""
    return ir.Study(
        name=f"Freed: {name}, {size[0]} x {size[1]}", scenes=[sponza()], cameras=["nave"], methods=methods, size=size, reference=NONE,
        repeats=3, max_repeats=5, images=False,
    )  # fmt: skip
