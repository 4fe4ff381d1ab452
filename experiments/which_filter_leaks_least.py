"""Which filter leaks least? Light that comes through closed walls of any thickness, angle and place, and sky that comes into a closed room,
beside what a ball hides too much: a filter that closes walls by swelling everything is no answer, so neither ranks alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure
from interreflect.scenes.builtin.dark_room import ALBEDO

RESOLUTION = 64
THICKNESSES, ANGLES, OFFSETS = (0.5, 1.5), (0.0, 15.0, 30.0, 45.0), (0.0, 0.25, 0.5)  # voxels, degrees, voxels
ROOFS, TURNS = (1.5, 4.0), (0.0, 30.0)  # of rooms under the sky: voxels, degrees
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
walls = [
    ir.scenes.thin_wall(thickness=t / RESOLUTION, rotation=a, offset=o / RESOLUTION) for t in THICKNESSES for a in ANGLES for o in OFFSETS
]
rooms = [
    ir.scenes.dark_room(thickness=t / RESOLUTION, rotation=a, offset=o / RESOLUTION) for t in ROOFS for a in TURNS for o in OFFSETS[::2]
]

study = ir.Study(
    name="which filter leaks least?",
    scenes=[
        *walls,
        *rooms,
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
    `sky`, mean share of the sky seen in a closed room, `worst_sky`; `hidden`, share of the sky that the ball hides beyond the truth.
    NaN for what was not measured."""
    kinds = {scene.hash: kind for kind, scenes in (("wall", walls), ("room", rooms), ("ball", [ball])) for scene in scenes}
    rows = []
    for configuration in dict.fromkeys(record.configuration for record in records):
        found = [record for record in records if record.configuration == configuration]
        seen = {(record.scene_hash, record.camera): float(records.images(record)[0].mean(dtype=np.float64)) for record in found}
        leaks = [light / seen[scene, "lit"] for (scene, camera), light in seen.items() if camera == "dark" and kinds[scene] == "wall"]
        skies = [light / ALBEDO for (scene, _), light in seen.items() if kinds[scene] == "room"]
        # A floor of albedo 1/2 under a sky of 1.
        hidden = [BALL - light / 0.5 for (scene, _), light in seen.items() if kinds[scene] == "ball"]
        measured = [fold(values) if values else np.nan for values, fold in ((leaks, np.mean), (leaks, max), (skies, np.mean), (skies, max))]
        rows.append((_name(found[0].knobs), found[0].knobs["march.correlation"], *measured, hidden[0] if hidden else np.nan))
    return pd.DataFrame(rows, columns=["filter", "correlation", "leak", "worst", "sky", "worst_sky", "hidden"])


def _name(knobs: Mapping[str, Any]) -> str:
    named = [knobs.get(f"prefilter.{name}") for name in ("kernel", "opacity")]
    return str(knobs["prefilter"]) + "".join(f", {word}" for word in named if word in ("tent", "columns"))


def chart(records: ir.Records) -> Figure:
    """Both leaks against the sky that a ball hides too much: best is low and at 0. Hollow: steps that are not correlated."""
    figure = new_figure((9.6, 5.0), dark=False)
    both = figure.subplots(1, 2)
    found = table(records)
    names = list(dict.fromkeys(found["filter"]))
    titles = ("light behind a closed wall / before it", "share of the sky that is seen in a closed room")
    row: Any
    for axes, column, title in zip(both, ("leak", "sky"), titles, strict=True):
        for row in found.itertuples():
            i = names.index(row.filter)
            colour = COLOURS[i % len(COLOURS)]
            hidden = 0.0 if np.isnan(row.hidden) else row.hidden
            axes.plot(
                [hidden], [getattr(row, column)], linestyle="none", color=colour, marker=MARKERS[i // len(COLOURS) % len(MARKERS)],
                markerfacecolor=colour if row.correlation else "none", label=row.filter if row.correlation else None,
            )  # fmt: skip
        axes.set_yscale("log")
        axes.axvline(0, color="#888888", linewidth=0.8)
        axes.set(xlabel="share of the sky that a ball hides beyond the truth", ylabel=title)
        dress(axes, dark=False)
    add_legend(figure, both, dark=False)
    return figure
