"""Figure 5.1: The scene with voxel grids of 64^3, 128^3 and 256^3."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared, freed
from experiments.shared.panels import as_light, panels

RESOLUTIONS = (64, 128, 256)


def studies() -> Sequence[ir.Study]:
    return [compared("resolution of the grid", [freed(grid__resolution=n) for n in RESOLUTIONS])]


def chart(records: ir.Records) -> Figure:
    """The picture above its indirect light."""
    truth, of_indirect = records.truth(records[0])
    pairs = [records.images(record) for record in records]
    names = [f"{n}^3" for n in RESOLUTIONS]
    above = [(name, as_light(pair[0], truth)) for name, pair in zip(names, pairs, strict=True)]
    below = [(f"{name}, indirect light", as_light(pair[1], of_indirect)) for name, pair in zip(names, pairs, strict=True)]
    return panels(
        [*above, ("truth", as_light(truth, truth)), *below, ("truth, indirect light", as_light(of_indirect, of_indirect))], columns=4
    )
