"""3.1: One cone a texel misses no bright part of the scene; one ray a texel does."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.ndimage import maximum_filter

import interreflect as ir
from experiments.rehfeld.sites import CARS, study
from experiments.shared.cache_picture import CachePicture
from experiments.shared.panels import as_light, panels

SIDE, ACROSS, DOWN = 16, 32, 16
FILLS = {
    "256 rays a texel": ir.TracedFill(resolution=SIDE, samples=256),
    "one ray a texel": ir.TracedFill(resolution=SIDE, samples=1),
    "one cone a texel": ir.ConeFill(resolution=SIDE),
}
BRIGHT = 4.0  # times a cache's mean radiance
MISSED = 0.5  # of what is there


def studies() -> Sequence[ir.Study]:
    maps = CachePicture.preset("Rehfeld 2014").replace({"show": "maps", "maps": ACROSS, "distribute": ir.Clustered(caches=1024)})
    ways = [maps.replace({"fill": fill}) for fill in FILLS.values()]
    return [study(CARS, "one ray or one cone a texel", ways, size=(SIDE * ACROSS, SIDE * DOWN))]


def maps_of(records: ir.Records, index: int) -> np.ndarray:
    """(caches, texels): mean of the channels."""
    picture = np.asarray(records.images(records[index])[0]).mean(2)
    rows, columns = picture.shape[0] // SIDE, picture.shape[1] // SIDE
    return picture.reshape(rows, SIDE, columns, SIDE).swapaxes(1, 2).reshape(-1, SIDE * SIDE)


def table(records: ir.Records) -> pd.DataFrame:
    """A row per way: share of the bright texels of which less than half is seen there, and there or beside it (cones see what is
    near where it is: a voxel is wider than a texel); and root mean squared error over the mean."""
    exact, rows = maps_of(records, 0), {}
    bright = exact > BRIGHT * exact.mean(1, keepdims=True)
    for i, name in enumerate(FILLS):
        seen = maps_of(records, i)
        off = float(np.sqrt(((seen - exact) ** 2).mean()) / exact.mean())
        beside = maximum_filter(seen.reshape(-1, SIDE, SIDE), size=(1, 3, 3)).reshape(seen.shape)
        missed = {"missed": seen, "nowhere near": beside}
        rows[name] = {kind: float((most < MISSED * exact)[bright].mean()) for kind, most in missed.items()} | {"difference": off}
    return pd.DataFrame(rows).T


def chart(records: ir.Records) -> Figure:
    found, shown = table(records), []
    exact = np.asarray(records.images(records[0])[0])
    for i, name in enumerate(FILLS):
        row = found.loc[name]
        title = f"{name}: {row['missed']:.1%} of bright texels missed, {row['nowhere near']:.1%} nowhere near, {row['difference']:.1%} off"
        shown.append((title, as_light(np.asarray(records.images(records[i])[0]), exact)))
    return panels(shown, columns=3)
