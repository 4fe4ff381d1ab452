"""Figure 4.7: The first four levels of the radiance texture."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_light, panels, picture
from experiments.shared.scenes import sunny_sponza
from experiments.shared.voxel_picture import VoxelPicture


def studies() -> Sequence[ir.Study]:
    level = VoxelPicture(light_voxels=ir.ShadowMapInjection(), prefilter=ir.VolumeCoverage(), exact=False)
    return [drawn("levels of the radiance", [level.replace({"level": number}) for number in range(4)], sunny_sponza())]


def chart(records: ir.Records) -> Figure:
    finest = picture(records, 0)
    return panels([(f"level {i}", as_light(picture(records, i), finest)) for i in range(4)])
