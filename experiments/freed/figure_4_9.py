"""Figure 4.9: Occlusion that results from cone tracing: white is open."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn, freed
from experiments.shared.occlusion_picture import OcclusionPicture
from experiments.shared.panels import as_share, panels, picture


def studies() -> Sequence[ir.Study]:
    return [drawn("occlusion", [OcclusionPicture(march=freed().march)])]


def chart(records: ir.Records) -> Figure:
    return panels([("share of the hemisphere that the cones leave open", as_share(picture(records)))], width=6.4)
