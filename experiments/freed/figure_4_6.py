"""Figure 4.6: Injected radiance: only voxels that the light hits have any."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_light, panels, picture
from experiments.shared.scenes import sunny_sponza
from experiments.shared.voxel_picture import VoxelPicture

NAMES = ("lit: albedo / pi times irradiance (as corrected)", "base colour (as printed)")


def studies() -> Sequence[ir.Study]:
    ways = [ir.ShadowMapInjection(radiance=radiance) for radiance in ("lit", "base_colour")]
    return [drawn("injected radiance", [VoxelPicture(light_voxels=way, exact=False) for way in ways], sunny_sponza())]


def chart(records: ir.Records) -> Figure:
    # Each at its own exposure: a base colour is no radiance.
    shown = [(name, as_light(picture(records, i), picture(records, i))) for i, name in enumerate(NAMES)]
    return panels(shown)
