"""4.3: A shadow map coarser than the voxels leaves gaps in the injected radiance."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import drawn
from experiments.shared.panels import as_light, panels, picture
from experiments.shared.scenes import sunny_sponza
from experiments.shared.voxel_picture import VoxelPicture

TEXELS = (64, 128, 256, 512, 1024, 4096)
RESOLUTION = 128


def studies() -> Sequence[ir.Study]:
    grid = ir.Grid(resolution=RESOLUTION)
    ways = [VoxelPicture(grid=grid, light_voxels=ir.ShadowMapInjection(size=texels), exact=False) for texels in TEXELS]
    return [drawn("shadow maps from coarse to fine", ways, sunny_sponza())]


def table(records: ir.Records) -> pd.DataFrame:
    """Texels along the map's side; how many of them cross a voxel, were both as wide as the scene; voxels that are lit, as a share of
    those that the finest map lights."""
    lit = records.table["stage.light_voxels.lit"]
    return pd.DataFrame({"texels": TEXELS, "texels a voxel": [n / RESOLUTION for n in TEXELS], "lit": lit / lit.iloc[-1]})


def chart(records: ir.Records) -> Figure:
    finest = picture(records, len(TEXELS) - 1)
    shown = [
        (
            f"{row['texels']:.0f}^2 texels, {row['texels a voxel']:.2g} a voxel\n{row['lit']:.0%} of the voxels lit",
            as_light(picture(records, i), finest),
        )
        for i, row in table(records).iterrows()
    ]
    return panels(shown, columns=3)
