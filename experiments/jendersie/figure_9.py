"""Figure 9: Where it fails: texels behind other geometry, a small spot that shows where links change, light between corridors."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import CLEAN, SMALL, Image, compared, composition, difference, indirect, precomputed
from experiments.shared.panels import as_light, groups
from experiments.shared.scenes import sponza_by_a_spot

LINKS = (32, 128, 512)
AMPLIFIED = 16.0  # of the dark corridor; 4096 in the paper, at which ours is white
TREES = {"agglomerative": ir.Agglomerative(), "kd-tree": ir.KdTree()}
ANGLE = 10.0  # half angle of the small spot, degrees


def room(texels: int = 64, backs: float = 0.5, links: int = 128, tree: Any = None, bounces: int | None = 1) -> Any:
    """Setting 2 for a room: a coarse map, so that texels reach under what stands on the floor, and a coarse grid."""
    caches = ir.LightMap(texels=texels, most_backs=backs, grid=ir.CacheGrid(nx=8, ny=8, nz=8, normal_offset=0.0))
    way = composition("setting 2", place_caches=caches, link__links=links, bounces=bounces)
    return way if tree is None else way.replace(cluster_surfels=tree)


def small_spot() -> ir.Scene:
    """The spot of Sponza's floor, narrow."""
    scene = sponza_by_a_spot()
    narrow = [dataclasses.replace(light, inner=0.75 * ANGLE, outer=ANGLE) for light in scene.lights]
    return scene.replace(lights=narrow, name="Sponza by a small spot")


def corridor_ways() -> dict[str, Any]:
    by_links = {f"{links} links": room(links=links) for links in LINKS}
    return {**by_links, "128 links, kd-tree": room(tree=TREES["kd-tree"]), "128 links, all bounces": room(bounces=None)}


def studies() -> Sequence[ir.Study]:
    texels = [room(backs=backs) for backs in (1.0, 0.5)]
    spots = [composition("setting 2", link__links=links) for links in LINKS]
    boxes = ir.scenes.corridors()
    ways = list(corridor_ways().values())
    return [
        compared("a box in the floor", texels, at=ir.scenes.sunk_box(), camera="front", size=(480, 360), reference=CLEAN),
        compared("a small spot", spots, at=small_spot(), size=SMALL, reference=CLEAN),
        compared("the dark corridor", ways, at=boxes, camera="dark", size=SMALL),
        compared("the lit corridor", ways, at=boxes, camera="lit", size=SMALL),
    ]


def leaks(dark: ir.Records, lit: ir.Records) -> pd.Series:
    """Mean indirect light of the dark corridor over that of the lit one, by way; the truth is 0."""
    means = {name: (indirect(dark, i).mean(), indirect(lit, i).mean()) for i, name in enumerate(corridor_ways())}
    return pd.Series({name: float(of_dark / of_lit) for name, (of_dark, of_lit) in means.items()})


def jumps(records: ir.Records) -> pd.Series:
    """Of neighbouring pixels' indirect light under the small spot, by links: 99.9th percentile of the difference beyond the truth's, over
    the truth's mean."""
    truth = np.asarray(records.truth(records[0])[1])
    return pd.Series(
        {links: float(np.quantile(_steps(indirect(records, i)) - _steps(truth), 0.999) / truth.mean()) for i, links in enumerate(LINKS)}
    )


def _steps(image: Image) -> Image:
    return np.asarray(np.abs(np.diff(image.mean(-1), axis=1)))


def misplaced(records: ir.Records) -> pd.Series:
    """Of the sunk box's picture, indirect light off from the truth: with all texels left where they are, and with backs culled."""
    truth = np.asarray(records.truth(records[0])[1])
    return pd.Series({name: difference(indirect(records, i), truth) for i, name in enumerate(("all texels kept", "backs culled"))})


def chart(box: ir.Records, spot: ir.Records, dark: ir.Records, lit: ir.Records) -> Figure:
    of_box, of_spot = (np.asarray(one.truth(one[0])[1]) for one in (box, spot))
    off, jagged, leaked = misplaced(box), jumps(spot), leaks(dark, lit)
    level = np.asarray(lit.truth(lit[0])[1])
    ways = list(corridor_ways())
    caches = precomputed(box, 0)["caches"]
    return groups(
        {
            f"(a) a box in the floor, {caches:,} caches: indirect light": [
                *((f"{name}: {value:.1%} off", as_light(indirect(box, i), of_box)) for i, (name, value) in enumerate(off.items())),
                ("path-traced truth", as_light(of_box, of_box)),
            ],
            "(b) a small spot: indirect light": [
                *((f"{n} links: jumps of {jagged[n]:.2f}", as_light(indirect(spot, i), of_spot)) for i, n in enumerate(LINKS)),
                ("path-traced truth", as_light(of_spot, of_spot)),
            ],
            f"(c) a dark corridor above a lit one, indirect light {AMPLIFIED:,.0f} times": [
                (f"{name}: {leaked[name]:.1e} of the lit one's", as_light(AMPLIFIED * indirect(dark, i), level))
                for i, name in enumerate(ways)
            ],
        },
        columns=4,
        width=3.6,
    )
