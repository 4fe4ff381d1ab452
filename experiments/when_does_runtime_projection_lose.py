"""When does run-time projection lose against links in spherical harmonics? What it costs to light caches, what links weigh, and the error,
over bands and links: the paper finds projection a little faster and smaller, and nearly as exact."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.ratios import ratio
from interreflect.charts.style import COLOURS, add_legend, dress, new_figure

composition = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=16384), place_caches=ir.LightMap(texels=64, grid=ir.CacheGrid(nx=12, ny=8, nz=12)),
)  # fmt: skip
LINKS, BANDS = (32, 254), tuple(range(2, 9))
BYTES_OF_A_CONE = 12

study = ir.Study(
    name="when does run-time projection lose?",
    scenes=[ir.scenes.cornell_box(), ir.scenes.atrium()],
    methods=[
        composition.replace(link=kind(links=links, bands=bands))
        for links in LINKS for bands in BANDS for kind in (ir.ShLinks, ir.RuntimeProjection)
    ],
    size=(160, 90),
    bounces=1,
    reference=ir.Reference(noise=2e-3, max_spp=1024),
    repeats=21,
    max_repeats=21,
    images=False,
)  # fmt: skip

LIGHTING = "stage.light_caches.milliseconds"
COLUMNS = ("time", "bytes", "error")
LABELS = {"time": "time to light caches", "bytes": "bytes of a link", "error": "indirect relMSE"}


def ratios(records: ir.Records) -> pd.DataFrame:
    """Of run-time projection over links in spherical harmonics: a row per scene, links and bands."""
    table = records.table[records.table["status"] == "ok"]
    rows = {}
    for (scene, links, bands), pair in table.groupby(["scene", "link.links", "link.bands"], sort=False):
        of = pair.set_index("link")
        if {"ShLinks", "RuntimeProjection"} <= set(of.index):
            cones, stored = of.loc["RuntimeProjection"], of.loc["ShLinks"]
            weight = BYTES_OF_A_CONE / (4 + 2 * int(bands) ** 2)
            rows[scene, links, bands] = (cones[LIGHTING] / stored[LIGHTING], weight, cones["indirect_relmse"] / stored["indirect_relmse"])
    return pd.DataFrame.from_dict(rows, orient="index", columns=list(COLUMNS))


def chart(records: ir.Records) -> Figure:
    """Projection over SH links, a panel per quantity and a line per scene and number of links; above 1 projection loses."""
    found = ratios(records)
    figure = new_figure((9.0, 3.2), dark=False)
    panels = figure.subplots(1, len(COLUMNS))
    for axes, column in zip(panels, COLUMNS, strict=True):
        lines = found.groupby(lambda key: key[:2], sort=False)
        for ((scene, links), points), colour in zip(lines, COLOURS, strict=False):
            name = f"{scene.partition('(')[0]}, {links} links"
            axes.plot([bands for _, _, bands in points.index], points[column], "o-", color=colour, label=name)
        axes.axhline(1, color="grey", linestyle="--", linewidth=0.8)
        axes.set(xlabel="bands", ylabel=f"{LABELS[column]}, projection / SH", yscale="log")
        dress(axes, dark=False)
    add_legend(figure, panels, dark=False)
    return figure


def told(records: ir.Records) -> str:
    """The finding in words: time and error of projection over links in spherical harmonics, with intervals over scenes and links."""
    found, lines = ratios(records), []
    for bands, rows in found.groupby(lambda key: key[2], sort=False):
        time, error = (ratio(list(rows[column])) for column in ("time", "error"))
        lines.append(
            f"{bands} bands: {time} of the time to light caches ({time.verdict}), {error.mean:.3f} of the error, "
            f"{rows['bytes'].iloc[0]:.2f} of the bytes"
        )
    return "\n".join(lines)
