"""5: Direct shadows marched by cones show the voxels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.pipeline import rehfeld
from experiments.shared.keep import QUALITY, SIZE
from experiments.shared.panels import as_light, panels
from experiments.shared.scenes import sponza

RESOLUTIONS = (64, 128, 256)


def studies() -> Sequence[ir.Study]:
    traced = rehfeld(shadow=ir.TracedShadows(), glossy=None)
    ways = [traced, *(rehfeld(shadow=ir.VoxelCones(), glossy=None, grid__resolution=n) for n in RESOLUTIONS)]
    return [
        ir.Study(
            name="Rehfeld: shadows by cones", scenes=[sponza()], cameras=["nave"], methods=ways, size=SIZE, bounces=1, reference=QUALITY,
            repeats=0,
        )
    ]  # fmt: skip


def wrong(records: ir.Records) -> dict[int, float]:
    """Resolution -> share of the pixels whose direct light is off by more than a quarter of the brightest percentile's."""
    exact = direct(records, 0)
    much = 0.25 * float(np.percentile(exact.mean(2), 99))
    return {n: float((np.abs(direct(records, 1 + i) - exact).mean(2) > much).mean()) for i, n in enumerate(RESOLUTIONS)}


def direct(records: ir.Records, index: int) -> np.ndarray:
    image, indirect = records.images(records[index])
    return np.asarray(image - indirect)


def chart(records: ir.Records) -> Figure:
    exact = direct(records, 0)
    shares = wrong(records)
    shown = [
        (f"cones, {n}^3 voxels\n{shares[n]:.1%} of the pixels wrong", as_light(direct(records, 1 + i), exact))
        for i, n in enumerate(RESOLUTIONS)
    ]
    return panels([("traced shadows", as_light(exact, exact)), *shown], title="direct light")
