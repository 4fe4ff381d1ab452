"""Which filter leaks least? Light that comes through closed walls of any thickness and angle, beside what a ball hides too much: a filter
that closes walls by swelling everything is no answer, so neither ranks alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import COLOURS, MARKERS, dress, new_figure

RESOLUTION = 64
THICKNESSES, ANGLES = (0.5, 1.5), (0.0, 15.0, 30.0, 45.0)  # voxels, degrees
BALL = 0.75  # of the sky is left under the ball: row 9 of the closed forms

FILTERS = (
    ir.VolumeCoverage(),
    ir.VolumeCoverage(kernel="tent"),
    ir.SurfaceCoverage(),
    ir.SurfaceCoverage(kernel="tent"),
    ir.SurfaceCoverage(opacity="columns"),
    ir.Anisotropic(),
    ir.OctantCoverage(),
    ir.OctantCoverage(opacity="columns"),
    ir.SphericalHarmonicVoxels(),
    ir.SphericalHarmonicVoxels(opacity="columns"),
)

ball = ir.scenes.blocked_sky("sphere", 0.3)

study = ir.Study(
    name="which filter leaks least?",
    scenes=[
        *(ir.scenes.thin_wall(thickness=t / RESOLUTION, rotation=a) for t in THICKNESSES for a in ANGLES),
        ball.replace(cameras={"lit": ball.cameras["point"]}),
    ],
    cameras=["dark", "lit"],
    methods=ir.sweep(
        ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION)),
        {"prefilter": list(FILTERS), "march.correlation": [0.0, 1.0]},
    ),
    size=(64, 48),
    reference=ir.Reference(noise=1e6, max_spp=2),  # the truths are closed forms: 0 and row 9
    repeats=0,
)


def table(records: ir.Records) -> pd.DataFrame:
    """A row per filter and correlation: `leak`, mean over walls of the dark room's radiance over the lit one's; `worst`, the largest;
    `hidden`, share of the sky that the ball hides beyond the truth (NaN where it was not measured)."""
    rows = []
    for configuration in dict.fromkeys(record.configuration for record in records):
        found = [record for record in records if record.configuration == configuration]
        seen = {(record.scene_hash, record.camera): float(records.images(record)[0].mean(dtype=np.float64)) for record in found}
        leaks = [seen[scene, "dark"] / seen[scene, "lit"] for scene, camera in seen if camera == "dark"]
        # A floor of albedo 1/2 under a sky of 1.
        left = [light / 0.5 for (scene, camera), light in seen.items() if camera == "lit" and (scene, "dark") not in seen]
        knobs = found[0].knobs
        named = {name: knobs.get(f"prefilter.{name}") for name in ("kernel", "opacity")}
        name = str(knobs["prefilter"]) + "".join(f", {word}" for word in named.values() if word in ("tent", "columns"))
        rows.append((name, knobs["march.correlation"], np.mean(leaks), max(leaks), BALL - left[0] if left else np.nan))
    return pd.DataFrame(rows, columns=["filter", "correlation", "leak", "worst", "hidden"])


def chart(records: ir.Records) -> Figure:
    """Leak against the sky that a ball hides too much: best is low and at 0. Hollow: steps that are not correlated."""
    figure = new_figure((6.4, 4.4), dark=False)
    axes = figure.subplots()
    found = table(records)
    names = list(dict.fromkeys(found["filter"]))
    row: Any
    for row in found.itertuples():
        i = names.index(row.filter)
        colour = COLOURS[i % len(COLOURS)]
        hidden = 0.0 if np.isnan(row.hidden) else row.hidden
        axes.plot(
            [hidden], [row.leak], linestyle="none", color=colour, marker=MARKERS[i // len(COLOURS) % len(MARKERS)],
            markerfacecolor=colour if row.correlation else "none", label=row.filter if row.correlation else None,
        )  # fmt: skip
    axes.set_yscale("log")
    axes.axvline(0, color="#888888", linewidth=0.8)
    axes.set(xlabel="share of the sky that a ball hides beyond the truth", ylabel="light behind a closed wall / before it")
    dress(axes, dark=False)
    axes.legend(fontsize=6.5, loc="upper right")
    return figure
