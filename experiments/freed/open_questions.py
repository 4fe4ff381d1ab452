"""5.4: Freed's open questions: directional voxels, curved grids, sparse storage, light shared between pixels."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.freed.pipeline import compared
from experiments.shared.panels import as_light, panels

NAMES = (
    "isotropic, volume coverage",
    "isotropic, surface coverage",
    "six faces",
    "six faces, in bricks",
    "spherical harmonics",
    "spherical frustum",
    "nested grids, 64 twice",
    "interleaved 2 x 2",
    "interleaved 4 x 4",
)


def ways() -> list[ir.methods.VoxelConeTracing]:
    """By name: 128^3 each, one thing changed. The cones are ours: Freed's multiply by occlusion, which blackens all that a filter keeps
    opaque."""
    plain = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=128), prefilter=ir.VolumeCoverage(), share=ir.EveryPixel(), glossy=None)
    changes = [
        {},
        {"prefilter": ir.SurfaceCoverage()},
        {"prefilter": ir.Anisotropic()},
        {"prefilter": ir.Anisotropic(dense_limit=0)},
        {"prefilter": ir.SphericalHarmonicVoxels()},
        {"grid.warp": ir.Spherical()},
        {"grid": ir.Grid(resolution=64, cascades=2)},
        {"share": ir.Interleaved(width=2, height=2)},
        {"share": ir.Interleaved(width=4, height=4)},
    ]
    return [plain.replace(change) for change in changes]


def studies() -> Sequence[ir.Study]:
    return [compared("open questions", ways())]


def table(records: ir.Records) -> pd.DataFrame:
    """Error, energy, memory of the pyramid and cones' steps, a row per way."""
    columns = ["indirect_relmse", "indirect_energy_ratio", "stage.prefilter.bytes", "stage.march.milliseconds", "indirect_noise"]
    return records.table[columns].set_axis(list(NAMES), axis=0)


def chart(records: ir.Records) -> Figure:
    truth = records.truth(records[0])[1]
    errors = table(records)["indirect_relmse"]
    shown = [
        (f"{name}\nindirect relMSE {errors[name]:.3f}", as_light(records.images(records[i])[1], truth)) for i, name in enumerate(NAMES)
    ]
    return panels([*shown, ("truth", as_light(truth, truth))], columns=3, title="indirect light")
