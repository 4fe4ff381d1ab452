"""Senders: Error of the light that comes from agglomerative clusters and from those of a kd-tree, against links of a cache."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import SMALL, composition, difference, indirect, milliseconds, study
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

LINKS = (32, 64, 128, 254)
TREES = {
    "agglomerative": ir.Agglomerative(),
    "agglomerative, normals alike": ir.Agglomerative(normal_weight=0.0),
    "agglomerative, not balanced": ir.Agglomerative(balance_weight=0.0),
    "kd-tree": ir.KdTree(),
    "kd-tree, by places alone": ir.KdTree(normal_weight=0.0),
}
SAMPLES = 16384  # of the exact light: every cache takes half of all surfels, one by one
CELLS = tuple((name, links) for name in TREES for links in LINKS)


def studies() -> Sequence[ir.Study]:
    """Same surfels, same caches; what all of the surfels send to them, one by one, is exact."""
    ways = [composition("setting 2", cluster_surfels=TREES[name], link__links=links) for name, links in CELLS]
    exact = composition("setting 2", link=ir.AllSurfels(samples=SAMPLES, bands=3, near_rays=0))
    return [study("clusters as senders", [*ways, exact], size=SMALL)]


def table(records: ir.Records) -> pd.DataFrame:
    """Indirect light off from that of all surfels, relative: a row per number of links, a column per tree."""
    exact = indirect(records, len(CELLS))
    off = pd.Series({cell: difference(indirect(records, i), exact) for i, cell in enumerate(CELLS)})
    return off.unstack(level=0)[list(TREES)]


def pulls(records: ir.Records) -> pd.Series:
    """Milliseconds of pulling, once, by tree."""
    return pd.Series({name: milliseconds(records, CELLS.index((name, LINKS[0])), ("pull",)) for name in TREES})


def chart(records: ir.Records) -> Figure:
    found = table(records)
    figure = new_figure((5.0, 3.6), dark=False)
    axes = figure.subplots()
    for name, colour, marker in zip(found, COLOURS, MARKERS, strict=False):
        axes.plot(found.index, found[name], color=colour, marker=marker, label=name)
    axes.set_xscale("log", base=2)
    axes.set_xticks(LINKS, [str(links) for links in LINKS])
    axes.set(xlabel="links of a cache", ylabel="relative error of indirect light", ylim=(0, None))
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False, columns=2)
    return figure
