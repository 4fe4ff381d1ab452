"""Figure 1.1: Sponza with global illumination and with a constant ambient term."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared, freed
from experiments.shared.panels import as_light, panels, picture


def studies() -> Sequence[ir.Study]:
    return [compared("with and without global illumination", [freed(), ir.methods.ConstantAmbient()])]


def chart(records: ir.Records) -> Figure:
    truth = records.truth(records[0])[0]
    names = ("global illumination: voxel cone tracing", "none: constant ambient term")
    shown = [(name, as_light(picture(records, i), truth)) for i, name in enumerate(names)]
    return panels([*shown, ("path-traced truth, one bounce", as_light(truth, truth))], columns=3)
