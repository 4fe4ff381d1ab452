"""3.1: Surface coverage keeps walls opaque in coarse levels where volume coverage thins them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import NONE
from experiments.shared.wall_opacity import WallOpacity
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

RESOLUTION = 64
LEVELS = 5


def wall() -> ir.Scene:
    """A wall across the z axis, one voxel thick, in a box of specks that keep the domain a cube."""
    corners = np.array([(-1, -1, 0.01), (1, -1, 0.01), (1, 1, 0.01), (-1, 1, 0.01)], np.float32)
    specks = [np.array([(x, x, x), (x, x - 1e-3 * x, x), (x - 1e-3 * x, x, x)], np.float32) for x in (-1.0, 1.0)]
    meshes = [ir.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]])), *(ir.Mesh(speck, np.array([[0, 1, 2]])) for speck in specks)]
    camera = ir.Camera(position=(0.0, 0.0, 3.0), target=(0.0, 0.0, 0.0), fov_x=60)
    return ir.Scene(
        meshes=meshes, lights=[ir.DirectionalLight(direction=(0, 0, -1), irradiance=(1, 1, 1))], cameras={"front": camera}, name="wall"
    )


def studies() -> Sequence[ir.Study]:
    grid = ir.Grid(resolution=RESOLUTION)
    ways = [WallOpacity(grid=grid, prefilter=way, levels=LEVELS) for way in (ir.VolumeCoverage(), ir.SurfaceCoverage())]
    return [ir.Study(name="Rehfeld: opacity of a wall", scenes=[wall()], methods=ways, size=(32, 18), bounces=0, reference=NONE, repeats=0)]


def table(records: ir.Records) -> pd.DataFrame:
    """Opacity across the wall: a row per level, a column per way to filter."""
    columns = [f"stage.prefilter.level_{level}" for level in range(LEVELS)]
    found = records.table.set_index("prefilter")[columns].T / 1e6
    return found.set_axis(range(LEVELS), axis=0)


def chart(records: ir.Records) -> Figure:
    figure = new_figure((5.0, 3.4), dark=False)
    axes = figure.subplots()
    found = table(records)
    for name, colour, marker in zip(found.columns, COLOURS, MARKERS, strict=False):
        axes.plot(found.index, found[name], color=colour, marker=marker, label=str(name))
    axes.set_xticks(range(LEVELS))
    axes.set_ylim(0, 1.05)
    axes.set(xlabel="level of the pyramid", ylabel="opacity across a wall of one voxel")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
