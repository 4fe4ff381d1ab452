"""Figure 4: An imperfect shadow map with holes, and the same after pulling and pushing."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.light_shadow_picture import LightShadowPicture
from experiments.shared.panels import as_share, panels, picture
from experiments.weinzierl_heigl.pipeline import replaced, study

BEFORE, AFTER = "drawn points", "two iterations of pull and push"
WAYS = {
    BEFORE: {"shadow_lights__iterations": 0},
    AFTER: {},
    "disks instead of squares, before": {"shadow_lights__iterations": 0, "shadow_lights__splat": "disk"},
    "disks instead of squares, after": {"shadow_lights__splat": "disk"},
}
# How far more levels, and more points, would go.
FURTHER = {
    "three iterations": {"shadow_lights__iterations": 3},
    "four iterations": {"shadow_lights__iterations": 4},
    "400,000 points, before": {"shadow_lights__iterations": 0, "shadow_lights__points": 400_000},
    "400,000 points, two iterations": {"shadow_lights__points": 400_000},
    "400,000 points, three iterations": {"shadow_lights__iterations": 3, "shadow_lights__points": 400_000},
}


def studies() -> Sequence[ir.Study]:
    maps = LightShadowPicture.preset("64 with PCSS")
    return [study("holes in shadow maps", [replaced(maps, **way) for way in (WAYS | FURTHER).values()], size=(512, 512))]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way, over the maps of all lights: `holes`, share of what a map should see that it does not; `closed`, share of what is open
    that it takes for surface; `empty`, share of empty texels."""
    rows = {}
    for name, record in zip(WAYS | FURTHER, records, strict=True):
        counts = record.stages["shadow_picture"]["counts"]
        surface, open_, holes, closed = (counts.get(what, 0) for what in ("surface", "open", "holes", "closed"))
        rows[name] = {
            "holes": holes / max(surface, 1),
            "closed": closed / max(open_, 1),
            "empty": (holes + open_ - closed) / (surface + open_),
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    shown = [
        (f"{name}: {row['empty']:.1%} empty;\n{row['holes']:.1%} of the surface open, {row['closed']:.1%} of the openings closed", i)
        for i, (name, row) in enumerate(table(records).loc[list(WAYS)].iterrows())
    ]
    return panels([(name, as_share(picture(records, i))) for name, i in shown], columns=2)
