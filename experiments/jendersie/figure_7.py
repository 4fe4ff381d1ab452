"""Figure 7: A box under a textured light, four asterisks and a ring, beside the path-traced picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import compared, composition, difference, precomputed
from experiments.shared.panels import as_light, panels

SURFELS = 40_000
TEXELS, CELLS = 128, 12  # 13,785 caches in the paper
BODIES = ("ball", "torus")


def way() -> Any:
    """Setting 1 with all bounces; the two bodies stand still and are lit by the grid, the room by the map."""
    caches = ir.LightMap(texels=TEXELS, grid=ir.CacheGrid(nx=CELLS, ny=CELLS, nz=CELLS))
    return composition(place_surfels=ir.RelaxedSurfels(surfels=SURFELS), place_caches=caches, bounces=None)


def studies() -> Sequence[ir.Study]:
    reference = ir.Reference(noise=1e-3, max_spp=1024)
    box = ir.scenes.textured_light_box()
    return [
        compared("a textured light", [way()], at=box, camera="front", size=(384, 384), bounces=None, reference=reference, repeats=3),
    ]


def table(records: ir.Records) -> pd.Series:
    """Of the whole picture: `off`, relative, and `flip`; `energy` of the indirect light over the truth's; `caches`; `milliseconds`."""
    record, (image, indirect), (truth, truly) = records[0], records.images(records[0]), records.truth(records[0])
    return pd.Series(
        {
            "off": difference(np.asarray(image), np.asarray(truth)),
            "flip": record.metrics["flip"],
            "energy": float(ir.metrics.energy_ratio(indirect, truly)),
            "caches": precomputed(records, 0)["caches"],
            "milliseconds": record.milliseconds,
        }
    )


def chart(records: ir.Records) -> Figure:
    found = table(records)
    (image, indirect), (truth, truly) = records.images(records[0]), records.truth(records[0])
    ours = f"{found['caches']:,.0f} caches, {found['milliseconds']:.0f} ms: {found['off']:.1%} off, FLIP {found['flip']:.3f}"
    return panels(
        [
            (f"40,000 surfels, {ours}", as_light(image, truth)),
            ("path-traced truth, all bounces", as_light(truth, truth)),
            (f"its indirect light, energy {found['energy']:.3f} of the truth's", as_light(indirect, truly)),
            ("truth's", as_light(truly, truly)),
        ]
    )
