"""Sibenik: The paper's comparisons in another building: ways to light it, bands of a glossy lobe, surfels against links."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie import figure_6, figure_10
from experiments.jendersie.pipeline import SMALL, Image, compared, composition, indirect
from experiments.shared.panels import as_light, groups
from experiments.shared.scenes import phong_sibenik, sunny_sibenik

REFERENCE = ir.Reference(noise=5e-3, max_spp=512)
BANDS = (2, 4, 6, 8)
CORNERS = tuple(figure_10.CELLS[i] for i in (0, 3, 12, 15))  # fewest and most of both


def ways() -> dict[str, Any]:
    return {**figure_6.ways(), "composition, setting 2": composition("setting 2")}


def studies() -> Sequence[ir.Study]:
    cells = [composition(place_surfels__surfels=surfels, link__links=links) for surfels, links in figure_10.CELLS]
    bands = [composition(link__bands=count) for count in BANDS]
    return [
        compared("Sibenik, one bounce", list(ways().values()), at=sunny_sibenik(), size=SMALL, reference=REFERENCE),
        compared("Sibenik, bands of a glossy lobe", bands, at=phong_sibenik(), size=SMALL, reference=REFERENCE),
        compared("Sibenik, surfels and links", cells, at=sunny_sibenik(), size=SMALL, reference=REFERENCE),
    ]


def chart(one: ir.Records, glossy: ir.Records, cells: ir.Records) -> Figure:
    corners = {f"{surfels // 1024}k surfels, {links} links": figure_10.CELLS.index((surfels, links)) for surfels, links in CORNERS}
    return groups(
        {
            "one bounce": pictures(one, {name: i for i, name in enumerate(ways())}),
            "exponent 30": pictures(glossy, {f"{count} bands": i for i, count in enumerate(BANDS)}),
            "surfels and links": pictures(cells, corners),
        },
        columns=3,
        width=3.6,
    )


def pictures(records: ir.Records, shown: dict[str, int]) -> list[tuple[str, Image]]:
    """Of the records with these numbers, and of their truth."""
    truth = np.asarray(records.truth(records[0])[1])

    def panel(name: str, i: int) -> tuple[str, Image]:
        ours = indirect(records, i)
        energy, flip = ir.metrics.energy_ratio(ours, truth), ir.metrics.flip(ours, truth)
        return f"{name}: energy {energy:.2f}, FLIP {flip:.2f}", as_light(ours, truth)

    return [*(panel(name, i) for name, i in shown.items()), ("path-traced truth", as_light(truth, truth))]
