"""The three questions, asked of every method on one view: which stage costs what, what does the scene need, what may be dropped?

    python tools/three_questions.py atrium|cornell_box|FILE [--size 320x180] [--seeds 4] [--trials 16] [--out results/three_questions]

Prints what was found, and leaves records, tables (CSV) and charts (PDF) in a folder of the scene's name; a second run goes on from there.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import interreflect as ir
from interreflect.catalogue import find_scene, parse_size

METHODS = (
    ir.methods.VoxelConeTracing(),
    ir.methods.AmbientOcclusion(),
    ir.methods.ConstantAmbient(),
    ir.methods.PathTracing(spp=4, bounces=1),
    ir.methods.PathTracingDenoised(bounces=1),
)
RANGES = {"grid.resolution": (16, 192), "spp": (1, 64)}
BUDGETS, BOUNDS = (30, 100, 300), (0.5, 0.2, 0.1, 0.05, 0.02)


class Questions:
    """Asks them of one scene; every answer is printed and kept in `folder`."""

    def __init__(self, scene: ir.Scene, size: tuple[int, int], seeds: int, trials: int, folder: Path) -> None:
        self.scene, self.size, self.seeds, self.trials, self.folder = scene, size, seeds, trials, folder
        self.reference = ir.Reference(noise=2e-3, max_spp=2048)
        self.common: dict[str, Any] = {"size": size, "reference": self.reference}
        folder.mkdir(parents=True, exist_ok=True)

    def attribution(self) -> None:
        for method in METHODS:
            place = self.folder / "records of the attribution"
            found = ir.attribute(method, self.scene, seeds=range(self.seeds), folder=place, **self.common)
            self._keep(f"attribution of {method.name}", str(found), found.table, found.chart())
            found.images().savefig(self.folder / f"attribution of {method.name}, images.png")

    def motion(self) -> None:
        """The camera goes forward by a quarter of a voxel a frame."""
        camera = next(iter(self.scene.cameras.values()))
        forward = np.subtract(camera.target, camera.position)
        step = tuple(float(share) for share in 0.25 * forward / np.linalg.norm(forward))
        dolly = ir.Motion.dolly(by=step, frames=8, voxels=128)
        for method in METHODS:
            found = ir.stability.motion(method, self.scene, dolly, size=(160, 90), reference=ir.Reference(noise=1e-9, max_spp=512))
            self._keep(f"motion of {method.name}", str(found), found.table, found.chart())
            found.filmstrip().savefig(self.folder / f"motion of {method.name}, frames.png")

    def ladder(self) -> None:
        found = ir.ladder(self.scene, seeds=range(self.seeds), folder=self.folder / "records of the ladder", **self.common)
        self._keep("ladder", str(found), found.table, found.chart())

    def sensitivity(self) -> None:
        for method in METHODS:
            place = self.folder / f"records of the sensitivity of {method.name}"
            ranges = {path: limits for path, limits in RANGES.items() if path in method.knobs()}
            found = ir.sensitivity(method, self.scene, size=(80, 60), ranges=ranges, samples=16, folder=place)
            self._keep(f"sensitivity of {method.name}", str(found), found.indices, found.chart())

    def search(self) -> None:
        study = ir.Study(
            name="search", scenes=[self.scene], methods=list(METHODS), size=self.size, reference=self.reference, bounces=1, repeats=3,
            max_repeats=7, images=False,
        )  # fmt: skip
        found = ir.search(study, trials=self.trials, ranges=RANGES, folder=self.folder / "records of the search")
        front, knobs = ir.pareto(found.records), found.records.knob_columns
        self._keep("search", f"{found}\n{shown(front, knobs)}", front, ir.charts.speed_accuracy(found.records))
        for milliseconds in BUDGETS:
            print(f"within {milliseconds} ms\n{shown(ir.equal_time(found.records, milliseconds=milliseconds), knobs)}")
        for bound in BOUNDS:
            print(f"relMSE of {bound:g} at most\n{shown(ir.cheapest(found.records, relmse=bound), knobs)}")

    def _keep(self, name: str, words: str, table: pd.DataFrame, figure: Any) -> None:
        print(f"\n## {self.scene.name}: {name}\n{words}", flush=True)
        table.to_csv(self.folder / f"{name}.csv", index=False)
        figure.savefig(self.folder / f"{name}.pdf")
        figure.savefig(self.folder / f"{name}.png", dpi=110)


def shown(table: pd.DataFrame, knobs: Sequence[str]) -> str:
    if table.empty:
        return "none"
    varied = [name for name in knobs if name in table and table[name].nunique() > 1]
    columns = [name for name in ("method", "milliseconds", "relmse", "note", *varied) if name in table]
    return table[columns].to_string(index=False, na_rep="", float_format=lambda number: f"{number:.4g}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", help="a scene file, or the name of a built-in scene")
    parser.add_argument("--size", default="320x180", help="of attribution, ladder and search; motion has 160 x 90, sensitivity 80 x 60")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--trials", type=int, default=16, help="settings of each method that the search tries")
    parser.add_argument("--questions", nargs="+", default=["attribution", "motion", "ladder", "sensitivity", "search"])
    parser.add_argument("--out", type=Path, default=Path("results/three_questions"))
    given = parser.parse_args()
    scene = find_scene(given.scene)
    questions = Questions(scene, parse_size(given.size), given.seeds, given.trials, given.out / scene.name)
    for question in given.questions:
        getattr(questions, question)()


if __name__ == "__main__":
    main()
