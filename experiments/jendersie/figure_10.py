"""Figure 10: Surfels against links of a cache: pictures and milliseconds."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import SMALL, compared, composition, difference, indirect, milliseconds, replaced, study
from experiments.shared.composition_picture import CompositionPicture
from experiments.shared.panels import as_light, as_share, groups, picture

SURFELS = (16384, 32768, 65536, 131072)
LINKS = (32, 64, 128, 254)
CELLS = tuple((surfels, links) for surfels in SURFELS for links in LINKS)  # in the order in which they share surfels and trees

PAPER_PRINTS = (
    "milliseconds on a GTX 980 with 16k, 32k, 64k, 128k surfels: surfels and pulling .23 .42 .82 1.80; caches of 32 links .22 .24 .25 .25, "
    "of 64 links .41 .43 .45 .49, of 128 links .96 .99 1.08 1.17, of 254 links 1.81 1.93 2.04 2.27"
)


def studies() -> Sequence[ir.Study]:
    """Small pictures: neither the surfels' light nor the caches' depends on the number of pixels."""
    ways = [composition(place_surfels__surfels=surfels, link__links=links) for surfels, links in CELLS]
    shown = replaced(CompositionPicture.preset("setting 1"), bounces=1, show="surfels", link__links=1, link__bands=1)
    placed = [replaced(shown, place_surfels__surfels=surfels) for surfels in SURFELS]
    return [
        compared("surfels and links", ways, size=SMALL, reference=ir.Reference(noise=2e-3, max_spp=512), repeats=5),
        study("surfels of each column", placed, size=SMALL),
    ]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per cell (surfels, links): milliseconds of `lighting` and pulling, and of `caches`; of the indirect light `energy` over the
    truth's, `off` from it, and `far`: off from the picture with the most surfels and links, which has the same caches and bands."""
    best = indirect(records, len(CELLS) - 1)
    rows = {}
    for i, cell in enumerate(CELLS):
        truth, ours = records.truth(records[i])[1], indirect(records, i)
        rows[cell] = {
            "lighting": milliseconds(records, i, ("light_surfels", "pull")),
            "caches": milliseconds(records, i, ("light_caches",)),
            "energy": float(ir.metrics.energy_ratio(ours, truth)),
            "off": difference(ours, truth),
            "far": difference(ours, best),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records, placed: ir.Records) -> Figure:
    found, truth = table(records), records.truth(records[0])[1]
    rows = {}
    for links in LINKS:
        rows[f"{links} links"] = [
            (
                f"{surfels // 1024}k: {row['lighting']:.1f} + {row['caches']:.1f} ms, {row['off']:.1%} off",
                as_light(indirect(records, CELLS.index((surfels, links))), truth),
            )
            for surfels in SURFELS
            for row in [found.loc[[(surfels, links)]].iloc[0]]
        ]
    rows["surfels"] = [(f"{surfels // 1024}k", as_share(picture(placed, i))) for i, surfels in enumerate(SURFELS)]
    return groups(rows, columns=4, width=3.2)
