"""Figure 7: A box under a textured light, four asterisks and a ring, beside the path-traced picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import compared, composition, difference, precomputed
from experiments.shared.panels import as_light, panels, picture

SURFELS = 40_000
TEXELS, CELLS = 128, 12  # 13,785 caches in the paper


ALL: dict[str, Any] = {"bounces": None, "emitters": "links"}
WAYS = {"rays to surfels, as the paper's": 0, "rays to what is near as well": 512}

PAPER_PRINTS = "195 frames a second on a GTX 980 with 40k surfels, 13,785 caches and many bounces; the truth took 62k samples a pixel"


def way(near_rays: int) -> Any:
    """Setting 1 with all bounces; emitters through links, as the paper's. Bodies are lit by the grid, the room by the map."""
    caches = ir.LightMap(texels=TEXELS, grid=ir.CacheGrid(nx=CELLS, ny=CELLS, nz=CELLS))
    surfels = ir.RelaxedSurfels(surfels=SURFELS)
    return composition(place_surfels=surfels, place_caches=caches, link__near_rays=near_rays, **ALL)


def studies() -> Sequence[ir.Study]:
    where: dict[str, Any] = {"at": ir.scenes.textured_light_box(), "camera": "front", "size": (384, 384)}
    ways = [way(rays) for rays in WAYS.values()]
    reference = ir.Reference(noise=1e-3, max_spp=1024)
    return [compared("a textured light", ways, bounces=None, reference=reference, repeats=3, **where)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way, of the whole picture: `off`, relative, `flip`, `energy` over the truth's; number of `caches`; `milliseconds`."""
    truth = np.asarray(records.truth(records[0])[0])
    rows = {}
    for i, (name, record) in enumerate(zip(WAYS, records, strict=True)):
        image = np.asarray(records.images(record)[0])
        rows[name] = {
            "off": difference(image, truth),
            "flip": record.metrics["flip"],
            "energy": float(ir.metrics.energy_ratio(image, truth)),
            "caches": precomputed(records, i)["caches"],
            "milliseconds": record.milliseconds,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    truth = np.asarray(records.truth(records[0])[0])
    shown = [
        (f"{name}: {row['off']:.1%} off, FLIP {row['flip']:.3f}, energy {row['energy']:.3f}", as_light(picture(records, i), truth))
        for i, (name, row) in enumerate(table(records).iterrows())
    ]
    return panels([*shown, ("path-traced truth, all bounces", as_light(truth, truth))])
