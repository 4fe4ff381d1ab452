"""Which settings of illuminance composition pay? Surfels, links, bands of luma and of chrominance, and where links are projected: 280 cells
that share ten precomputations a scene, and what none of the others beats in both time and error."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure

composition = ir.methods.IlluminanceComposition(place_caches=ir.LightMap(texels=64, grid=ir.CacheGrid(nx=12, ny=8, nz=12)))
SURFELS, LINKS = (4096, 16384), (16, 32, 64, 128, 254)
BANDS = ((2, 0), (3, 0), (3, 2), (4, 0), (4, 2), (6, 0), (6, 3))  # of luma and of chrominance; 0: as many
KINDS = {ir.ShLinks: "SH links", ir.RuntimeProjection: "run-time projection"}

study = ir.Study(
    name="which settings of composition pay?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=[
        composition.replace({
            "place_surfels.surfels": surfels, "link": kind(links=links, bands=bands),
            "evaluate": ir.SphericalHarmonicLobes(chrominance_bands=chrominance),
        })
        for surfels in SURFELS for links in LINKS for kind in KINDS for bands, chrominance in BANDS
    ],
    size=(320, 180),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=1024),
    repeats=7,
    max_repeats=7,
    images=False,
)  # fmt: skip


def front(records: ir.Records) -> pd.DataFrame:
    """What is not beaten in frame time and indirect relMSE, fastest first."""
    return ir.pareto(records, y="indirect_relmse")


def told(row: Any) -> str:
    """A setting in few words: surfels, links, bands."""
    chrominance = f":{row['evaluate.chrominance_bands']}" if row["evaluate.chrominance_bands"] else ""
    kind = "" if row["link"] == "ShLinks" else " projected"
    return f"{row['place_surfels.surfels'] // 1024}k, {row['link.links']}, {row['link.bands']}{chrominance}{kind}"


def chart(records: ir.Records) -> Figure:
    """Indirect relMSE against the frame's time, a panel per scene; what nothing beats is joined and named: surfels, links, bands."""
    table = records.table[records.table["status"] == "ok"]
    best = front(records)
    figure = new_figure((5.4 * table["scene"].nunique(), 4.2), dark=False)
    panels = figure.subplots(1, table["scene"].nunique(), squeeze=False)[0]
    for axes, (scene, rows) in zip(panels, table.groupby("scene", sort=False), strict=True):
        for (kind, points), colour in zip(rows.groupby("link", sort=False), COLOURS, strict=False):
            name = next(words for technique, words in KINDS.items() if technique.__name__ == kind)
            axes.plot(points["milliseconds"], points["indirect_relmse"], ".", color=colour, markersize=3, label=name)
        of_scene = best[best["scene"] == scene]
        axes.step(of_scene["milliseconds"], of_scene["indirect_relmse"], where="post", color="black", linewidth=0.8, label="not beaten")
        for _, row in of_scene.iterrows():
            place = (row["milliseconds"], row["indirect_relmse"])
            axes.annotate(told(row), place, xytext=(3, 3), textcoords="offset points", fontsize=5)
        axes.set(title=scene, xscale="log", yscale="log", xlabel="frame, ms (median)", ylabel="indirect relMSE")
        dress(axes, dark=False)
    add_legend(figure, panels, dark=False)
    return figure
