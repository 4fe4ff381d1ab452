"""Figure 4.5: A shadow map, depth in the red component."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_share, panels, picture
from experiments.shared.shadow_map_picture import ShadowMapPicture


def studies() -> Sequence[ir.Study]:
    return [drawn("shadow map", [ShadowMapPicture(texels=4096)])]


def chart(records: ir.Records) -> Figure:
    return panels([("depth that the sun sees, 4096 x 4096 texels", as_share(picture(records)))], width=6.4)
