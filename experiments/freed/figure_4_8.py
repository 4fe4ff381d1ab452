"""Figure 4.8: Diffuse and specular indirect light from cone tracing."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared, freed
from experiments.shared.panels import as_light, panels
from experiments.shared.scenes import glossy_sponza


def studies() -> Sequence[ir.Study]:
    return [compared("diffuse and specular indirect light", [freed(glossy=None), freed()], glossy_sponza())]


def chart(records: ir.Records) -> Figure:
    diffuse, both = (records.images(record)[1] for record in records)
    truth = records.truth(records[0])[1]
    shown = [("diffuse indirect light", diffuse), ("specular indirect light", both - diffuse), ("truth, both", truth)]
    return panels([(name, as_light(image, truth)) for name, image in shown], columns=3)
