"""When is tessellation worth it? Error of indirect light and time to voxelize, for every voxelizer over exact overlap, on every scene:
how many triangles it takes until a cheaper way is as good."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.places import scenes
from experiments.shared.ratios import over, ratio, strips
from interreflect.study.configurations import configurations

RESOLUTIONS = (64, 128)
EXACT = "exact overlap"
VOXELIZERS: Mapping[str, Any] = {
    EXACT: ir.ExactOverlap(),
    "tessellation as printed": ir.Tessellation(spacing=1.0, split=False, levels="uniform"),
    "tessellation, corrected": ir.Tessellation(),
    "surface sampling": ir.SurfaceSampling(),
    "rasterization": ir.Rasterization(),
}
# A pixel's cones are its own, and light comes by rays: nothing but the voxels differs.
base = ir.methods.VoxelConeTracing(glossy=None, share=ir.EveryPixel())


def study_of(places: Sequence[ir.Scene]) -> ir.Study:
    methods = [base.replace({"voxelize": way, "grid.resolution": n}) for n in RESOLUTIONS for way in VOXELIZERS.values()]
    return ir.Study(
        name="when is tessellation worth it?", scenes=places, methods=methods, size=(320, 180), bounces=1,
        reference=ir.Reference(noise=5e-4, max_spp=512), repeats=2, max_repeats=2, images=False,
    )  # fmt: skip


def measure(folder: Path) -> pd.DataFrame:
    """A row per scene, resolution and voxelizer: `error` (relMSE of indirect light), `milliseconds` of voxelization, `triangles`."""
    places = scenes()
    return table(ir.run(study_of(places), folder), places)


def table(records: ir.Records, places: Sequence[ir.Scene]) -> pd.DataFrame:
    triangles = {place.name: sum(len(mesh.triangles) for mesh in place.meshes) for place in places}
    found = configurations(records)
    ways = len(VOXELIZERS)
    order = {record.configuration: list(VOXELIZERS)[index % ways] for index, record in enumerate(records)}
    return pd.DataFrame(
        {
            "scene": found["scene"],
            "triangles": found["scene"].map(triangles),
            "resolution": found["grid.resolution"].astype(int),
            "way": found["configuration"].map(order),
            "error": found["indirect_relmse"],
            "milliseconds": found["stage.voxelize.milliseconds"],
        }
    )


def compared(found: pd.DataFrame, value: str) -> pd.DataFrame:
    return over(found, value, "way", EXACT, ("scene", "triangles", "resolution"))


def chart(found: pd.DataFrame) -> Figure:
    """Two panels at the finest resolution: error, and time to voxelize, over exact overlap's."""
    panels, finest = {}, found["resolution"].max()
    for value, title in (("error", "relMSE of indirect light"), ("milliseconds", "time to voxelize")):
        rows = compared(found, value)[lambda rows: rows["resolution"] == finest]
        panels[f"{title}, {finest}^3"] = {str(name): list(group["ratio"]) for name, group in rows.groupby("way", sort=False)}
    return strips(panels, "over exact overlap's (dots: scenes)")


def told(found: pd.DataFrame) -> str:
    """The finding in words: of all scenes, and of those with few and with many triangles a voxel."""
    errors, times = compared(found, "error"), compared(found, "milliseconds")
    middle = found["triangles"].median()
    lines = []
    for (n, way), rows in errors.groupby(["resolution", "way"], sort=False):
        same = times[(times[["resolution", "way"]] == [n, way]).all(axis=1)]
        lines.append(f"{n}^3, {way}: {ratio(list(rows['ratio']))} of the error, {ratio(list(same['ratio']))} of the time to voxelize")
        for title, few in ((f"at most {middle:.0f} triangles", True), (f"more than {middle:.0f} triangles", False)):
            part = rows[(rows["triangles"] <= middle) == few]["ratio"]
            time = same[(same["triangles"] <= middle) == few]["ratio"]
            lines.append(f"    {title}: {ratio(list(part))} of the error, {ratio(list(time))} of the time")
    return "\n".join(lines)
