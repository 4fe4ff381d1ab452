"""Figure 5.8: The spline warp has only a small effect."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared, freed
from experiments.shared.panels import as_light, panels, picture
from experiments.shared.scenes import glossy_sponza

NAMES = ("without warp", "spline warp, alpha 0.25", "without warp, 128^3")


def studies() -> Sequence[ir.Study]:
    ways = [freed(), freed(grid__warp=ir.CubicSpline(alpha=0.25)), freed(grid__resolution=128)]
    return [compared("spline warp", ways, glossy_sponza())]


def chart(records: ir.Records) -> Figure:
    truth = records.truth(records[0])[0]
    return panels([(name, as_light(picture(records, i), truth)) for i, name in enumerate(NAMES)], columns=3)
