"""`./run demo`: every method at a few settings on built-in scenes (or Sponza), against truth: table, charts, pictures, one page."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import interreflect as ir

if TYPE_CHECKING:
    from rich.table import Table

VARIED = ("grid.resolution", "share", "spp")
NUMBERS = ("ms", "relMSE", "indirect", "energy", "FLIP")


def methods() -> list[Any]:
    """Every method at a few settings; all render one indirect bounce."""
    cones = ir.methods.VoxelConeTracing()
    return [
        ir.methods.ConstantAmbient(),
        *ir.sweep(cones, {"grid.resolution": [32, 64, 128]}),
        cones.replace({"share": ir.EveryPixel()}),
        *(ir.methods.PathTracing(spp=spp, bounces=1) for spp in (1, 4, 16)),
        *(ir.methods.PathTracingDenoised(spp=spp, bounces=1) for spp in (1, 4)),
    ]


def demo_study(sponza: bool) -> ir.Study:
    scenes = [ir.load_scene("sponza_crytek/scene.toml")] if sponza else [ir.scenes.cornell_box(), ir.scenes.atrium()]
    return ir.Study(
        name="demo sponza" if sponza else "demo",
        scenes=scenes,
        methods=methods(),
        size=(640, 360) if sponza else (320, 180),
        bounces=1,
        reference=ir.Reference(noise=2e-3, max_spp=512),
        repeats=3,
        max_repeats=5,
    )


def tables(records: ir.Records) -> list[Table]:
    """A table a scene, narrow enough for a terminal of 80 columns."""
    from rich import box
    from rich.table import Table

    made = []
    for scene, rows in records.table.groupby("scene", sort=False):
        shown = Table(
            title=f"{scene}: time, relMSE of all light and of indirect light",
            box=box.SIMPLE_HEAD,
            padding=(0, 1, 0, 0),
            pad_edge=False,
            show_edge=False,
        )
        shown.add_column("method", no_wrap=True)
        shown.add_column("setting", no_wrap=True)
        for column in NUMBERS:
            shown.add_column(column, justify="right", no_wrap=True)
        for row in rows.to_dict("records"):
            errors = [f"{row[name]:.3g}" for name in ("relmse", "indirect_relmse")]
            numbers = [f"{row['milliseconds']:.0f}", *errors, f"{row['energy_ratio']:.3f}", f"{row['flip']:.3f}"]
            shown.add_row(str(row["method"]), _setting(row), *numbers)
        made.append(shown)
    return made


def _setting(row: Mapping[Any, Any]) -> str:
    """The knobs that `methods` varies."""
    known = {name: row[name] for name in VARIED if row.get(name) is not None and row[name] == row[name]}
    if known.get("share") == ir.methods.VoxelConeTracing().knobs()["share"]:
        del known["share"]
    return "\n".join(f"{name.rpartition('.')[2]} {value:g}" if isinstance(value, float) else str(value) for name, value in known.items())


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="./run demo", description=__doc__)
    parser.add_argument("scene", nargs="?", choices=["sponza"], help="instead of the built-in scenes")
    given = parser.parse_args(arguments)
    from rich.console import Console

    folder = Path("results") / ("demo-sponza" if given.scene else "demo")
    records = ir.run(demo_study(given.scene == "sponza"), folder)
    console = Console()
    for table in tables(records):
        console.print(table)
    ir.charts.speed_accuracy(records).savefig(folder / "speed_accuracy.png", dpi=150)
    ir.charts.stages(records).savefig(folder / "stages.png", dpi=150)
    ir.charts.images(records).savefig(folder / "images.png", dpi=150)
    ir.report(records, folder / "report.html")
    print(f"Pictures, charts and the page: {folder}/report.html")


if __name__ == "__main__":
    main()
