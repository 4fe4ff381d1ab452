"""Bounces: How light grows, frame by frame, where the last frame's caches light the surfels."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import CLEAN, compared, difference, indirect, milliseconds, replaced
from experiments.shared.composition_picture import ProgressiveComposition
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

FRAMES = (1, 2, 3, 4, 6, 8, 12, 16)
LIGHT = ("light_surfels", "light_surfels_again", "pull", "light_caches")
SIZE = (256, 192)


def studies() -> Sequence[ir.Study]:
    """A white-walled room, where many bounces matter; beside the truth of all bounces, and the caches' own limit."""
    caches = ir.LightMap(texels=64, grid=ir.CacheGrid(nx=8, ny=8, nz=8))
    ways = [replaced(ProgressiveComposition.preset("setting 2"), place_caches=caches, frames=frames) for frames in (*FRAMES, 64)]
    box = ir.scenes.cornell_box(light="point")
    return [compared("a bounce a frame", ways, at=box, camera=None, size=SIZE, bounces=None, reference=CLEAN, repeats=3)]


def table(records: ir.Records) -> pd.DataFrame:
    """A row per frame: `truth`, indirect light off from the truth of all bounces; `limit`, off from frame 64's; `milliseconds` of light."""
    limit = indirect(records, len(FRAMES))
    rows = {}
    for i, frame in enumerate(FRAMES):
        truth = np.asarray(records.truth(records[i])[1])
        ours = indirect(records, i)
        rows[frame] = {"truth": difference(ours, truth), "limit": difference(ours, limit), "milliseconds": milliseconds(records, i, LIGHT)}
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    found = table(records)
    figure = new_figure((5.0, 3.4), dark=False)
    axes = figure.subplots()
    names = {"truth": "off from the path-traced truth", "limit": "off from frame 64"}
    for (column, label), colour, marker in zip(names.items(), COLOURS, MARKERS, strict=False):
        axes.plot(found.index, found[column], color=colour, marker=marker, label=label)
    axes.set(xlabel="frame", ylabel="relative error of indirect light", yscale="log")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
