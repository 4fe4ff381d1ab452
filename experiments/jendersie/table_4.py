"""Table 4: Bytes of surfels, caches and links, as they lie in memory and as the paper's formulas have them."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import FULL, GRID, MIB, composition, precomputed, projected, study
from experiments.jendersie.table_2 import SETTINGS
from experiments.shared.panels import table_figure

WAYS = tuple((name, kind) for name in SETTINGS for kind in ("SH links", "projection"))
# MiB; setting 2's printed totals leave buffer 9 out, setting 1's do not (ERRATA).
PRINTED = {("setting 1", "SH links"): 104.3, ("setting 1", "projection"): 42.8} | {
    ("setting 2", "SH links"): 32.2,
    ("setting 2", "projection"): 19.3,
}
CACHES, ON_MAP = 10585, 8281  # the paper's of Sponza: 2,304 of them stand in the grid
SURFELS = {"setting 1": 128_000, "setting 2": 32_000}  # the paper's thousands are no powers of two
PARTS = ("surfels and tree", "links", "caches", "indices and copies")

PAPER_PRINTS = "in the table's columns, by its formulas; its totals in the title"


def studies() -> Sequence[ir.Study]:
    """As in table 2, so that SH links are measured once."""
    cones = study("both settings, links projected in the frame", [projected(name) for name in SETTINGS], size=FULL, repeats=5, images=False)
    return [study("both settings", [composition(name) for name in SETTINGS], size=FULL, repeats=5, images=False), cones]


def formulas(surfels: int, caches: int, on_map: int, links: int, luma: int, chrominance: int, texels: int, kind: str) -> dict[str, float]:
    """MiB by the paper's formulas [5.3.4], corrected: 80 bytes a surfel; 4 ceil(n_L / 2)(2 + l^2) or 12 n_L a cache; four coefficients of
    half floats in 8 bytes of a texel, 8 R (ceil(l_Y^2 / 4) + 2 ceil(l_C^2 / 4)) (printed: 24 R(...)); an index a texel of the map, and
    buffer 9: the map's caches once more, before they are copied to their texels, 64 bytes each with 16 coefficients."""
    coefficients = ceil(luma**2 / 4) + 2 * ceil(chrominance**2 / 4)
    of_links = 4 * ceil(links / 2) * (2 + luma**2) if kind == "SH links" else 12 * links
    on_grid = GRID.nx * GRID.ny * GRID.nz
    parts = (80 * surfels, caches * of_links, 8 * (texels**2 + on_grid) * coefficients, 4 * texels**2 + 4 * luma**2 * on_map)
    return {name: count / MIB for name, count in zip(PARTS, parts, strict=True)}


def paper(name: str, kind: str) -> dict[str, float]:
    way = composition(name)
    bands = way.link.bands
    return formulas(SURFELS[name], CACHES, ON_MAP, way.link.links, bands, bands, way.place_caches.texels, kind)


def ours(records: ir.Records, index: int) -> dict[str, float]:
    """MiB as they lie in memory. What is read at a pixel's texel lies beside where caches stand."""
    counts, stages = precomputed(records, index), records[index].stages
    tree = counts["surfel_bytes"] + stages["pull"]["bytes"] + stages["light_surfels"]["bytes"]
    parts = (tree, counts["link_bytes"], stages["light_caches"]["bytes"], counts["site_bytes"])
    return {name: count / MIB for name, count in zip(PARTS, parts, strict=True)}


def table(sh_links: ir.Records, cones: ir.Records) -> pd.DataFrame:
    """MiB: a row per part and for the sum; columns (setting and kind, ours, formulas, or formulas with our number of caches)."""
    columns = {}
    for name, kind in WAYS:
        records = sh_links if kind == "SH links" else cones
        index = SETTINGS.index(name)
        of_paper = paper(name, kind)
        found = precomputed(records, index)["caches"]
        scaled = {**of_paper, "links": of_paper["links"] * found / CACHES}
        for whose, parts in (("ours", ours(records, index)), ("paper", of_paper), (f"paper, {found} caches", scaled)):
            columns[f"{name}\n{kind}", whose] = {**parts, "sum": sum(parts.values())}
    return pd.DataFrame(columns)


def chart(sh_links: ir.Records, cones: ir.Records) -> Figure:
    printed = ", ".join(f"{name} by {kind} {PRINTED[name, kind]:g}" for name, kind in WAYS)
    return table_figure(table(sh_links, cones), f"MiB (printed totals: {printed})")
