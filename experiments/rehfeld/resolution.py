"""4: Voxel resolution above about 128^3 brings no noticeable gain, depending on the glossiness."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.pipeline import rehfeld
from experiments.shared.scenes import phong_sponza
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

RESOLUTIONS = (32, 64, 128, 256)
EXPONENTS = (10, 50, 500)


def studies() -> Sequence[ir.Study]:
    """A study per exponent of the Phong lobe: each is a scene of its own."""
    ways = [rehfeld(grid__resolution=n) for n in RESOLUTIONS]
    return [
        ir.Study(
            name=f"Rehfeld: resolution of the voxels, exponent {exponent}",
            scenes=[phong_sponza(exponent)],
            cameras=["nave"],
            methods=ways,
            size=(320, 180),
            bounces=1,
            reference=ir.Reference(noise=1e-2, max_spp=256),
            repeats=0,
        )
        for exponent in EXPONENTS
    ]


def errors(records: ir.Records) -> dict[int, float]:
    """Resolution -> relMSE of the indirect light, less the truth's own."""
    table = records.table
    return {
        int(n): max(e - noise, 0.0)
        for n, e, noise in zip(table["grid.resolution"], table["indirect_relmse"], table["indirect_noise"], strict=True)
    }


def chart(*records: ir.Records) -> Figure:
    figure = new_figure((5.2, 3.6), dark=False)
    axes = figure.subplots()
    for exponent, one, colour, marker in zip(EXPONENTS, records, COLOURS, MARKERS, strict=False):
        of = errors(one)
        axes.plot(list(of), list(of.values()), color=colour, marker=marker, label=f"Phong exponent {exponent}")
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xticks(RESOLUTIONS, [f"{n}^3" for n in RESOLUTIONS])
    axes.set(xlabel="resolution of the voxels", ylabel="relMSE of indirect light")
    dress(axes, dark=False)
    add_legend(figure, [axes], dark=False)
    return figure
