"""Figure 7: Point lights against virtual area lights at equal time, without shadows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.light_picture import LightPicture
from experiments.shared.panels import Image, as_light, as_share, groups, picture
from experiments.weinzierl_heigl.pipeline import FULL, MAP, area_lights, difference, indirect, milliseconds, replaced, study

COUNTS = (64, 128, 256, 512, 1024, 2048)
AREA = "128 area lights"
# What the paper's way to lights costs them: the flux of a cluster's centre, and seeds warped by the specular term, which points are not.
MEMBERS, BY_FLUX = "the same with the flux of all members", "these with seeds warped by flux"
CHANGES = {
    AREA: {},
    MEMBERS: {"cluster_lights__flux": "members"},
    BY_FLUX: {"cluster_lights__flux": "members", "sample_lights__importance": "flux"},
}
# What the paper adds up: illumination, and for area lights their clusters. 13 ms both.
STAGES = ("cluster_lights", "shade_lights", "shade")
BRIGHT = 1.5  # times the truth: what is seen as a bright spot

PAPER_PRINTS = "256 point lights 13 ms, 128 area lights 8 ms and 5 ms to cluster, on a Radeon HD 6850"


def studies() -> Sequence[ir.Study]:
    """Neither casts shadows, so what both approximate is very many lights without shadows, each a disk of its own texels."""
    points = [area_lights("256 points", sample_lights__lights=count) for count in COUNTS]
    truth = area_lights("256 points", sample_lights__lights=16384, shade_lights=ir.DiskVector(), share=ir.EveryPixel())
    areas = [area_lights(AREA, **change) for change in CHANGES.values()]
    lights = [
        replaced(LightPicture.preset("256 points"), show="lights"),
        replaced(LightPicture.preset(AREA), show="clusters"),
    ]
    return [
        study("points and area lights", [*points, *areas], size=FULL, repeats=5),
        study("very many lights", [truth], size=FULL),
        study("where points and area lights stand", lights, size=MAP),
    ]


def table(timed: ir.Records, many: ir.Records, _places: ir.Records) -> pd.DataFrame:
    """A row per number of points, and the area lights: `milliseconds` of the indirect light as the paper counts them, `frame`, and of the
    indirect light `off`, relative difference; `dull_off`, the same where what is right is below its brightest hundredth, the highlight on
    the glossy box; and `spots`, share of the pixels half as bright again as they should be."""
    truth = indirect(many, 0)
    level = np.maximum(truth.mean(-1), 1e-2 * truth.mean())
    dull = (truth.mean(-1) < np.quantile(truth.mean(-1), 0.99))[..., None]
    rows = {}
    for i, name in enumerate([*(f"{count} points" for count in COUNTS), *CHANGES]):
        ours = indirect(timed, i)
        rows[name] = {
            "milliseconds": milliseconds(timed, i, STAGES),
            "frame": timed[i].milliseconds,
            "off": difference(ours, truth),
            "dull_off": difference(ours * dull, truth * dull),
            "spots": float((ours.mean(-1) > BRIGHT * level).mean()),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def at_equal_time(found: pd.DataFrame) -> str:
    """The most points that take no longer than the area lights; the fewest where all do."""
    points = found.drop(index=list(CHANGES))
    within = points[points["milliseconds"] <= found.loc[AREA, "milliseconds"]]
    return str(within.index[-1] if len(within) else points.index[0])


def chart(timed: ir.Records, many: ir.Records, places: ir.Records) -> Figure:
    found = table(timed, many, places)
    names = list(dict.fromkeys(["256 points", at_equal_time(found), AREA]))
    truth, whole = indirect(many, 0), np.asarray(many.images(many[0])[0])
    of_indirect: list[tuple[str, Image]] = []
    of_all: list[tuple[str, Image]] = []
    for name in names:
        row, i = found.loc[name], list(found.index).index(name)
        title = f"{name}: {row['milliseconds']:.0f} ms, {row['off']:.1%} off, {row['spots']:.2%} too bright"
        of_indirect.append((title, as_light(indirect(timed, i), truth)))
        of_all.append(("all light", as_light(timed.images(timed[i])[0], whole)))
    return groups(
        {
            "the light's map": [("256 points", as_share(picture(places, 0))), ("128 clusters", as_share(picture(places, 1)))],
            "indirect light without shadows (paper: 13 ms both)": [*of_indirect, ("16,384 disks", as_light(truth, truth))],
            "with direct light": [*of_all, ("16,384 disks", as_light(whole, whole))],
        },
        columns=3,
    )
