"""`./run demo`: every method at a few settings on built-in scenes (or Sponza), against truth: table, charts, pictures, one page."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import interreflect as ir


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


def show(records: ir.Records) -> None:
    from rich.console import Console
    from rich.table import Table

    shown = Table(title="Time and error of every method (one indirect bounce)")
    columns = ("scene", "method", "setting", "ms", "relMSE", "indirect relMSE", "energy", "FLIP")
    for column in columns:
        shown.add_column(column, justify="left" if column in columns[:3] else "right")
    for row in records.table.to_dict("records"):
        known = [name for name in ("grid.resolution", "share", "spp") if row.get(name) is not None and row[name] == row[name]]
        setting = ", ".join(f"{name}={row[name]:g}" if isinstance(row[name], float) else f"{name}={row[name]}" for name in known)
        numbers = [f"{row[key]:.4g}" for key in ("milliseconds", "relmse", "indirect_relmse", "energy_ratio", "flip")]
        shown.add_row(str(row["scene"]), str(row["method"]), setting, *numbers)
    Console().print(shown)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="./run demo", description=__doc__)
    parser.add_argument("scene", nargs="?", choices=["sponza"], help="instead of the built-in scenes")
    given = parser.parse_args(arguments)
    folder = Path("results") / ("demo-sponza" if given.scene else "demo")
    records = ir.run(demo_study(given.scene == "sponza"), folder)
    show(records)
    ir.charts.speed_accuracy(records).savefig(folder / "speed_accuracy.png", dpi=150)
    ir.charts.stages(records).savefig(folder / "stages.png", dpi=150)
    ir.charts.images(records).savefig(folder / "images.png", dpi=150)
    ir.report(records, folder / "report.html")
    print(f"Pictures, charts and the page: {folder}/report.html")


if __name__ == "__main__":
    main()
