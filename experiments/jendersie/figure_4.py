"""Figure 4: The patches that one cache on a wall is linked to."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import replaced, study
from experiments.shared.composition_picture import CompositionPicture
from experiments.shared.panels import as_share, panels, picture

CAMERAS = ("nave", "gallery")


def studies() -> Sequence[ir.Study]:
    """The cache in the middle of each view, with few links, so that patches are seen."""
    shown = replaced(CompositionPicture.preset("setting 2"), show="links", bounces=1)
    return [study(f"links of the cache in the middle of the {camera}", [shown], camera=camera, size=(960, 540)) for camera in CAMERAS]


def chart(*records: ir.Records) -> Figure:
    shown = []
    for camera, one in zip(CAMERAS, records, strict=True):
        counts = one[0].stages["picture"]["counts"] | one[0].stages["precomputed"]["counts"]
        share = counts["linked_surfels"] / counts["surfels"]
        shown.append((f"{camera}: {counts['patches']} patches of {share:.0%} of the surfels", as_share(picture(one))))
    return panels(shown, columns=1, width=8.0)
