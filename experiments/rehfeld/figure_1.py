"""Figure 1: Cars and Sponza with all light, with indirect light alone, and the voxels that it comes from."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching
from experiments.rehfeld.sites import by_site, everywhere
from experiments.shared.panels import Image, as_colour, as_light, groups
from experiments.shared.voxel_picture import VoxelPicture

REFERENCE = ir.Reference(noise=1e-2, max_spp=64)


def studies() -> Sequence[ir.Study]:
    # The paper's suns cast their shadows through the voxels.
    shown = [caching(shadow=ir.VoxelCones()), caching(shadow=ir.TracedShadows())]
    voxels = VoxelPicture(grid=ir.Grid(resolution=128), voxelize=ir.SurfaceSampling(), exact=False)
    return [*everywhere("pictures", shown, reference=REFERENCE), *everywhere("voxels", [voxels])]


def chart(*records: ir.Records) -> Figure:
    return groups({site: _shown(*its) for site, its in by_site(records).items()}, columns=3)


def _shown(records: ir.Records, voxels: ir.Records) -> list[tuple[str, Image]]:
    truth, of_indirect = records.truth(records[0])
    image, light = records.images(records[0])
    traced = records.images(records[1])[0]
    return [
        ("all light, shadows by cones", as_light(image, truth)),
        ("indirect light", as_light(light, of_indirect)),
        ("voxels, 128^3", as_colour(voxels.images(voxels[0])[0])),
        ("all light, traced shadows", as_light(traced, truth)),
        ("path-traced truth, one bounce", as_light(truth, truth)),
        ("its indirect light", as_light(of_indirect, of_indirect)),
    ]
