"""Figure 8: Glossy surfaces of exponent 30 by two to eight bands, by both kinds of links, and with fewer bands of chrominance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import MIB, SMALL, Image, compared, composition, difference, indirect, precomputed, projected
from experiments.shared.panels import as_light, groups

BANDS = (2, 3, 4, 5, 6, 7, 8)
SHOWN = (2, 4, 6, 8)
EXACT = "the links by the BRDF itself"
AMPLIFIED = 2.0  # as in the paper


def ways() -> dict[str, Any]:
    """In the order in which they share links."""
    links = {f"SH links, {bands} bands": composition(link__bands=bands) for bands in BANDS}
    direct = {EXACT: composition(link__bands=8, evaluate=ir.DirectLinks())}
    cones = {f"projection, {bands} bands": projected(link__bands=bands) for bands in BANDS}
    compressed = {
        f"projection, {luma}:{chrominance} bands": projected(link__bands=luma, evaluate__chrominance_bands=chrominance)
        for luma, chrominance in ((8, 4), (8, 2), (6, 3), (4, 2))
    }
    return {**links, **direct, **cones, **compressed}


def studies() -> Sequence[ir.Study]:
    """Beside a truth of the same lobe; small, as what is compared are caches."""
    reference = ir.Reference(noise=2e-3, max_spp=1024)
    return [compared("bands of a glossy lobe", list(ways().values()), size=SMALL, reference=reference)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way, of the indirect light: `off` from the truth, relative; `truncated`: off from the same links by the BRDF itself;
    `lost`: off from the same bands without compression; `links`: MiB."""
    names = list(ways())
    truth, exact = np.asarray(records.truth(records[0])[1]), indirect(records, names.index(EXACT))
    rows = {}
    for i, name in enumerate(names):
        ours = indirect(records, i)
        rows[name] = {
            "off": difference(ours, truth),
            "truncated": difference(ours, exact),
            "lost": difference(ours, indirect(records, names.index(_whole(name)))),
            "links": precomputed(records, i)["link_bytes"] / MIB,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def _whole(name: str) -> str:
    """The way with as many bands of chrominance as of luma."""
    return name.partition(":")[0] + " bands" if ":" in name else name


def chart(records: ir.Records) -> Figure:
    found, names, truth = table(records), list(ways()), np.asarray(records.truth(records[0])[1])

    def shown(name: str) -> tuple[str, Image]:
        image = AMPLIFIED * indirect(records, names.index(name))
        return f"{name}: {found.loc[name, 'off']:.1%} off, {found.loc[name, 'links']:.0f} MiB", as_light(image, truth)

    eight = [indirect(records, names.index(f"{kind}, 8 bands")) for kind in ("SH links", "projection")]
    apart = np.abs(eight[0] - eight[1])
    few = f"projection, {SHOWN[-1]}:4 bands"
    return groups(
        {
            "links in spherical harmonics": [shown(f"SH links, {bands} bands") for bands in SHOWN],
            "projected in the frame": [shown(f"projection, {bands} bands") for bands in SHOWN],
            "eight bands, indirect light twice": [
                shown(few),
                shown(EXACT),
                (f"|SH links - projection|, {difference(eight[1], eight[0]):.1%}", as_light(AMPLIFIED * apart, truth)),
                ("path-traced truth, one bounce", as_light(AMPLIFIED * truth, truth)),
            ],
        },
        columns=4,
        width=3.6,
    )
