"""5: Under camera motion caches jump. What does it lessen to keep last frame's places?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import NONE
from experiments.shared.panels import as_share, panels, picture
from experiments.shared.popping import POP, Popping
from experiments.shared.scenes import sponza

SIZE = (320, 180)
CACHES = 512  # 112 pixels each: tiles of some 10 pixels
FLOOR = "a cache at every pixel"
KEEPING = "clustered, kept"
WAYS = {
    "clustered": ir.Clustered(caches=CACHES),
    KEEPING: ir.ReuseCaches(distribute=ir.Clustered(caches=CACHES)),
    "clustered, one kept each": ir.ReuseCaches(distribute=ir.Clustered(caches=CACHES), most=1, spacing=0.0),
    "cube faces": ir.CubeFaceClustered(caches=CACHES),
    "equidistant": ir.Equidistant(caches=CACHES),
    FLOOR: ir.CachePerPixel(),
}
PAN = {"turn": 0.25}  # degrees a frame: a pixel or two
DOLLY = {"by": 0.001}
CASES = {  # name -> (scene, its camera, motion)
    "depth edge, pan": (ir.scenes.depth_edge, "front", PAN),
    "grille, pan": (ir.scenes.grille, "front", PAN),
    "atrium, dolly": (ir.scenes.atrium, "court", DOLLY),
    "Sponza, pan": (sponza, "nave", PAN),
}


def without_gloss(scene: ir.Scene) -> ir.Scene:
    return scene.replace(materials={"*": {"specular": (0.0, 0.0, 0.0)}})


def studies() -> Sequence[ir.Study]:
    """A study a motion; in each, the ways to place caches. Maps of 8 x 8 will do for diffuse light."""
    keys = {"fill": ir.ConeFill(resolution=8), "light_voxels": ir.TracedLighting(both_sides=True), "shadow": ir.TracedShadows(samples=1)}
    return [
        ir.Study(
            name=f"Rehfeld: popping, {name}", scenes=[without_gloss(scene())], cameras=[camera], size=SIZE, bounces=0, reference=NONE,
            repeats=0, methods=[Popping(distribute=way, **motion, **keys) for way in WAYS.values()],
        )
        for name, (scene, camera, motion) in CASES.items()
    ]  # fmt: skip


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per motion and way: change between frames at surface points in shares of the mean indirect radiance (`mean`, `p99`, `max`),
    share of the points that pop, caches, and which share of them was kept. beyond: the mean less that of a cache at every pixel, which
    is what resampling a picture makes."""
    rows = {}
    for case, one in zip(CASES, records, strict=True):
        found = one.table.filter(like="stage.popping.").rename(columns=lambda name: name.removeprefix("stage.popping."))
        for k, way in enumerate(WAYS):
            row = found.iloc[k]
            shares = {name: float(row[name]) / 1e6 for name in ("mean", "p99", "max", "pops")}
            kept = float(np.nan_to_num(row["reused_caches"])) / float(row["caches"])
            rows[case, way] = {**shares, "caches": float(row["caches"]), "kept": kept}
    made = pd.DataFrame(rows).T
    floor = made["mean"].xs(FLOOR, level=1)
    return made.assign(beyond=made["mean"] - floor.reindex(made.index, level=0))


def chart(*records: ir.Records) -> Figure:
    found, shown = table(*records), []
    for case, one in zip(CASES, records, strict=True):
        highest = float(np.percentile(picture(one, 0), 99))
        for k, way in enumerate(WAYS):
            row = found.loc[(case, way)]
            title = f"{case}: {way}\nmean {row['mean']:.3f}, {row['pops']:.1%} pop"
            shown.append((title, as_share(picture(one, k) / highest)))
    return panels(
        shown, columns=len(WAYS), width=3.0,
        title=f"change of indirect light between frames at surface points, share of its mean; a pop is more than {POP:g}",
    )  # fmt: skip
