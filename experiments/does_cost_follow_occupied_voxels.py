"""Does cost follow occupied voxels? Time and memory of every stage from 32^3 to 512^3, with the pyramid in bricks and dense: of Sponza
where its files are, and of the built-in atrium."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.charts.style import COLOURS, MARKERS, dress, new_figure

RESOLUTIONS = (32, 64, 128, 256, 512)
BRICKS, DENSE = 0, 131072  # MiB that a dense level may have
LARGEST_DENSE = 256  # eight volumes of 512^3 would take gigabytes
STAGES = ("voxelize", "light_voxels", "prefilter", "march")


def scenes() -> list[ir.Scene]:
    try:
        return [ir.scenes.atrium(), ir.load_scene("sponza_crytek/scene.toml")]
    except FileNotFoundError:
        return [ir.scenes.atrium()]


def method(resolution: int, dense_limit: int) -> ir.methods.VoxelConeTracing:
    return ir.methods.VoxelConeTracing(
        grid=ir.Grid(resolution=resolution), prefilter=ir.OctantCoverage(dense_limit=dense_limit), glossy=None
    )


study = ir.Study(
    name="does cost follow occupied voxels?",
    scenes=scenes(),
    methods=[
        *(method(n, BRICKS) for n in RESOLUTIONS),
        *(method(n, DENSE) for n in RESOLUTIONS if n <= LARGEST_DENSE),
    ],
    size=(320, 180),
    reference=ir.Reference(noise=1e6, max_spp=2),  # nothing is compared with it
    repeats=3,
    max_repeats=5,
)


def chart(records: ir.Records) -> Figure:
    """Time and memory of the last scene's stages against its voxels, and against the cells of a cube of that resolution. Dashed: dense
    levels. Grey: in proportion."""
    table = records.table
    table = table[table["scene"] == table["scene"].iloc[-1]].sort_values("grid.resolution")
    figure = new_figure((9, 6.5), dark=False)
    for i, axes in enumerate(figure.subplots(2, 2).flat):
        what, label = (("milliseconds", "time, ms"), ("bytes", "memory, bytes"))[i // 2]
        for dense in (False, True):
            found = table[(table["prefilter.dense_limit"] == DENSE) == dense]
            x = found["stage.prefilter.voxels"] if i % 2 == 0 else found["grid.resolution"] ** 3
            for k, stage in enumerate(STAGES):
                if dense and stage not in ("prefilter", "march"):
                    continue
                name = stage if i == 0 and not dense else None
                axes.plot(x, found[f"stage.{stage}.{what}"], "--" if dense else "-", color=COLOURS[k], marker=MARKERS[k], label=name)
            if not dense:
                y = found[f"stage.prefilter.{what}"]
                ends = np.array([x.min(), x.max()], float)
                axes.plot(ends, y.iloc[-1] * ends / x.iloc[-1], ":", color="#888888", linewidth=0.8)
        axes.set(xscale="log", yscale="log", xlabel="occupied voxels" if i % 2 == 0 else "cells of the cube", ylabel=label)
        dress(axes, dark=False)
        if i == 0:
            axes.legend(fontsize=7)
    return figure
