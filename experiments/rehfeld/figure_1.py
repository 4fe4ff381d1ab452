"""Figure 1: The cars with all light, with indirect light alone, and the voxels that it comes from."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import SMALL, caching, cars
from experiments.shared.panels import as_colour, as_light, panels
from experiments.shared.voxel_picture import VoxelPicture

REFERENCE = ir.Reference(noise=1e-2, max_spp=64)


def studies() -> Sequence[ir.Study]:
    # The paper's suns cast their shadows through the voxels.
    shown = [caching(shadow=ir.VoxelCones()), caching(shadow=ir.TracedShadows())]
    voxels = VoxelPicture(grid=ir.Grid(resolution=128), voxelize=ir.SurfaceSampling(), exact=False)
    return [cars("pictures", shown, reference=REFERENCE), cars("voxels", [voxels], size=SMALL)]


def chart(records: ir.Records, voxels: ir.Records) -> Figure:
    truth, of_indirect = records.truth(records[0])
    image, light = records.images(records[0])
    traced = records.images(records[1])[0]
    return panels(
        [
            ("all light, shadows by cones", as_light(image, truth)),
            ("indirect light", as_light(light, of_indirect)),
            ("voxels, 128^3", as_colour(voxels.images(voxels[0])[0])),
            ("all light, traced shadows", as_light(traced, truth)),
            ("path-traced truth, one bounce", as_light(truth, truth)),
            ("its indirect light", as_light(of_indirect, of_indirect)),
        ],
        columns=3,
    )
