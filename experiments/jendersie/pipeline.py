"""The paper's configurations as methods, its scene, and the studies that its figures are drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from experiments.shared.composition_picture import MeasuredComposition
from experiments.shared.keep import NONE, QUALITY, SIZE
from experiments.shared.scenes import sunny_phong_sponza

FULL = (1920, 1080)  # the paper's pictures
SMALL = (320, 180)  # where a truth with little noise is wanted
MIB = 2**20
CLEAN = ir.Reference(noise=2e-3, max_spp=1024)  # at SMALL
GRID = ir.CacheGrid(nx=24, ny=8, nz=12, normal_offset=0.0)  # the paper's, of Sponza

Image = NDArray[np.floating[Any]]


def composition(preset: str = "setting 1", **changes: Any) -> MeasuredComposition:
    """A preset of one bounce with knobs replaced; `link__bands=3` is the knob link.bands.

    The preset's own bounces are all of them, one more a frame; a frame by itself would take as many passes as converge.
    """
    return replaced(MeasuredComposition.preset(preset), **{"bounces": 1, **changes})


def projected(preset: str = "setting 1", **changes: Any) -> MeasuredComposition:
    """The same with links that are projected when caches are lit."""
    way = composition(preset)
    cones = ir.RuntimeProjection(links=way.link.links, bands=way.link.bands, near_rays=way.link.near_rays)
    return replaced(way, link=cones, **changes)


def replaced(method: Any, **changes: Any) -> Any:
    return method.replace({name.replace("__", "."): value for name, value in changes.items()})


def study(
    name: str, methods: Sequence[Any], at: ir.Scene | None = None, camera: str | None = "nave", size: tuple[int, int] = SIZE,
    reference: ir.Reference = NONE, repeats: int = 0, images: bool = True, bounces: int | None = 1,
) -> ir.Study:  # fmt: skip
    """Pictures of the paper's scene, or of another; not timed unless `repeats` says so."""
    return ir.Study(
        name=f"Jendersie: {name}", scenes=[at or sunny_phong_sponza()], cameras=[camera] if camera else None, methods=methods, size=size,
        bounces=bounces, reference=reference, repeats=repeats, max_repeats=2 * max(repeats, 1), images=images,
    )  # fmt: skip


def compared(name: str, methods: Sequence[Any], **how: Any) -> ir.Study:
    """Beside the truth."""
    return study(name, methods, **{"reference": QUALITY, **how})


def indirect(records: ir.Records, index: int) -> Image:
    return np.asarray(records.images(records[index])[1])


def difference(image: Image, exact: Image) -> float:
    """Root of the mean squared difference over the mean of what is right."""
    return float(np.sqrt(((image - exact) ** 2).mean()) / exact.mean())


def milliseconds(records: ir.Records, index: int, stages: Sequence[str]) -> float:
    """Of these stages together, of one record."""
    return sum(float(records[index].stages[stage]["milliseconds"]) for stage in stages if stage in records[index].stages)


def precomputed(records: ir.Records, index: int) -> dict[str, int]:
    """Counts of what a record's frame took from precomputation (MeasuredComposition)."""
    return dict(records[index].stages["precomputed"]["counts"])
