"""Do traced rays with shared samples beat cones? Error against the march's time: cones, rays of each pixel, rays shared by a tile."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.places import of_all_kinds
from experiments.shared.ratios import ratio
from interreflect.study.configurations import configurations

TIME, ERROR = "stage.march.milliseconds", "indirect_relmse"
KINDS = {"rays of each pixel": 1, "rays shared by 16 x 16": 16}
cones = ir.methods.VoxelConeTracing()


def study_of(scenes: Sequence[ir.Scene]) -> ir.Study:
    rays = cones.replace({"march": ir.TracedRays()})
    return ir.Study(
        name="do traced rays with shared samples beat cones?",
        scenes=scenes,
        methods=ir.sweep(cones, {"march.cones": [6, 12, 24, 40, 80]})
        + ir.sweep(rays, {"march.tile": list(KINDS.values()), "march.samples": [1, 4, 16, 64]}),
        size=(320, 180),
        seeds=range(3),
        bounces=1,
        reference=ir.Reference(noise=5e-4, max_spp=512),
        repeats=2,
        max_repeats=2,
    )


def measure(folder: Path) -> ir.Records:
    return ir.run(study_of([place.make() for place in of_all_kinds()]), folder)


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the march's time, a line per kind of march; along a line, more cones or rays."""
    return ir.charts.curves(records, x=TIME, by=["march", "march.tile"], x_label="time of the march, ms (median)")


def against_cones(records: ir.Records) -> pd.DataFrame:
    """A row per scene, number of cones and kind of rays: the least error of rays in no more time than these cones take, over the cones';
    without a row where even the fewest rays take longer."""
    table, rows = configurations(records), []
    for scene, found in table.groupby("scene", sort=False):
        for _, ours in found[found["march"] == "DiffuseCones"].iterrows():
            for kind, tile in KINDS.items():
                within = found[(found["march"] == "TracedRays") & (found["march.tile"] == tile) & (found[TIME] <= ours[TIME])]
                if len(within) and ours[ERROR] > 0 and within[ERROR].min() > 0:
                    rows.append({"scene": scene, "cones": ours["march.cones"], "kind": kind, "ratio": within[ERROR].min() / ours[ERROR]})
    return pd.DataFrame(rows, columns=["scene", "cones", "kind", "ratio"])


def told(records: ir.Records) -> str:
    """The finding in words, with intervals over scenes."""
    lines = []
    for (kind, count), rows in against_cones(records).groupby(["kind", "cones"], sort=False):
        error = ratio(list(rows["ratio"]))
        lines.append(f"{kind}, in the time of {count:.0f} cones: {error} of their error ({error.verdict})")
    return "\n".join(lines)
