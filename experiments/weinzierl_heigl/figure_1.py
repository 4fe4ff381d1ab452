"""Figure 1: Virtual point lights are singular in a corner, and bounding the geometry term hides it and loses energy."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.panels import as_light, panels
from experiments.weinzierl_heigl.pipeline import area_lights, difference, indirect, replaced, study

WAYS = {"points": ir.Point(), "points, bounded": ir.ClampedPoint(bound=20.0), "disks": ir.PointToDisk()}
LIGHTS, MANY = 64, 16384


def studies() -> Sequence[ir.Study]:
    """The spot's light reaches down to the floor. Every light at every pixel: no merge smooths what is singular. Nothing casts a shadow
    here, so the truth is very many lights, each a disk of its own texels: paths would leave noise in the corner."""
    points = area_lights("256 points", sample_lights__lights=LIGHTS, share=ir.EveryPixel())
    ways = [points.replace({"shade_lights": shade}) for shade in WAYS.values()]
    truth = replaced(points, sample_lights__lights=MANY, shade_lights=ir.DiskVector())
    corner = ir.scenes.corner(light="spot", aim=0.15)
    return [study("points in a corner", [*ways, truth], at=corner, camera="view", size=(512, 512))]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way: `energy` of the indirect light and `brightest` pixel, over the truth's; `off`, relative difference."""
    truth = indirect(records, len(WAYS))
    rows = {}
    for i, name in enumerate(WAYS):
        ours = indirect(records, i)
        rows[name] = {
            "energy": float(ir.metrics.energy_ratio(ours, truth)),
            "brightest": float(ours.max() / truth.max()),
            "off": difference(ours, truth),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    found, truth = table(records), indirect(records, len(WAYS))
    shown = []
    for i, (name, row) in enumerate(found.iterrows()):
        title = f"{LIGHTS} {name}: energy {row['energy']:.3f}, brightest {row['brightest']:.2f}, {row['off']:.1%} off"
        shown.append((title, as_light(indirect(records, i), truth)))
    return panels([*shown, (f"{MANY:,} disks, indirect light", as_light(truth, truth))])
