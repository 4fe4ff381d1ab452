"""Figure 8: Shadows of 64 lights by simple lookups, by PCSS, and as they are."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.panels import as_light, panels
from experiments.weinzierl_heigl.pipeline import CLEAN, SMALL, Image, area_lights, compared, difference, indirect

TRUTH = "rays to each light's texels"
WAYS = {
    "simple lookup": {"filter_shadows": ir.SimpleLookup()},
    "PCSS": {"filter_shadows": ir.Pcss()},
    TRUTH: {"shadow_lights": ir.TracedVisibility(), "filter_shadows": ir.TracedDisk(samples=32)},
}


def studies() -> Sequence[ir.Study]:
    """Every light at every pixel: the merge of neighbours would smooth what a lookup leaves jagged. Small: 118 million rays."""
    return [
        compared("lookups of shadows", [area_lights(share=ir.EveryPixel(), **way) for way in WAYS.values()], size=SMALL, reference=CLEAN)
    ]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per lookup, of the indirect light against the same lights' by rays: `off`, relative difference; `jagged`, the same of the
    differences between neighbouring pixels, which smooth errors leave alone; `dull_off` and `dull_jagged`, both where what is right is
    below its brightest hundredth: the highlight on the glossy box outweighs all else."""
    images = [indirect(records, i) for i in range(len(WAYS))]
    exact = images[list(WAYS).index(TRUTH)]
    level = exact.mean(-1)
    dull = (level < np.quantile(level, 0.99))[..., None]
    rows = {}
    for name, one in zip(WAYS, images, strict=True):
        error = one - exact
        rows[name] = {
            "off": difference(one, exact),
            "jagged": jagged(error) / exact.mean(),
            "dull_off": float(np.sqrt(((error * dull) ** 2).mean()) / (exact * dull).mean()),
            "dull_jagged": jagged(error * dull) / (exact * dull).mean(),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def jagged(error: Image) -> float:
    """Root mean square step of an error from a pixel to the next, across and down."""
    across, down = np.diff(error, axis=1), np.diff(error, axis=0)
    return float(np.sqrt((np.square(across).mean() + np.square(down).mean()) / 2))


def chart(records: ir.Records) -> Figure:
    found, truth = table(records), np.asarray(records.truth(records[0])[1])
    shown = [
        (f"{name}: {row['off']:.1%} off, {row['jagged']:.2%} a pixel jagged", as_light(indirect(records, i), truth))
        for i, (name, row) in enumerate(found.iterrows())
    ]
    return panels([*shown, ("path-traced truth, one bounce, indirect light", as_light(truth, truth))])
