"""Which method is nearest to one bounce, and to all, within a time: on every scene, still and moving, and by how much?

`python -m experiments.head_to_head [scene ...]` measures what is missing, scene by scene, and prints who wins; without a scene, on all that
are here. Records, tables, charts and a page lie in a folder of each scene's name, `winners.csv` and `winners.md` beside them.
`./run figures head_to_head` draws who wins. Black may win by relMSE, which is why FLIP stands beside it.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.contenders import contenders
from experiments.shared.keep import FOLDER
from experiments.shared.moving import in_motion
from experiments.shared.places import moved, places
from experiments.shared.winners import as_markdown, front_of, table_of_winners, winners_in_motion, winners_of
from experiments.shared.winners_chart import who_wins

__all__ = ["chart", "measure"]

HERE = FOLDER / "head_to_head"
SIZE, SEEDS = (320, 180), (0, 1, 2)
FRAMES = 7  # of a motion: six after the first, the fewest of whose median an interval is known
LIGHT: Mapping[str, int | None] = {"one bounce": 1, "all bounces": None}
# Of a minute on two cores at most, for Sponza.
TRUTH: Mapping[int | None, ir.Reference] = {1: ir.Reference(noise=5e-4, max_spp=512), None: ir.Reference(noise=5e-4, max_spp=256)}
TRUTH_OF_A_FRAME = ir.Reference(noise=1e-3, max_spp=256)
TIMEOUT = 300.0  # seconds that a cell may take, its precomputation with it


def study_of(name: str, scene: ir.Scene, bounces: int | None) -> ir.Study:
    """Two timed frames of three seeds each: six, the fewest of whose median an interval is known."""
    return ir.Study(
        name=f"head to head: {name}", scenes=[scene], methods=list(contenders(bounces).values()), size=SIZE, seeds=SEEDS,
        bounces=bounces, reference=TRUTH[bounces], repeats=2, max_repeats=2,
    )  # fmt: skip


def measure_one(name: str, scene: ir.Scene, folder: Path) -> pd.DataFrame:
    """The winners of one scene; its records, tables, chart and page in its folder."""
    motion, found = moved(scene, FRAMES), []
    for light, bounces in LIGHT.items():
        kept, ways = folder / light.replace(" ", "_"), contenders(bounces)
        records = ir.run(study_of(f"{name}, {light}", scene, bounces), kept / "records", timeout=TIMEOUT)
        moving = in_motion(ways, scene, motion, SIZE, bounces, TRUTH_OF_A_FRAME, kept / "moving")
        moving.to_csv(kept / "moving.csv", index=False)
        ir.charts.speed_accuracy(records).savefig(kept / "speed_accuracy.png", dpi=110)
        ir.report(records, kept / "page.html", front_of(moving))
        still = winners_of(records, list(ways))
        found += [still.assign(light=light, kind="still"), winners_in_motion(moving).assign(light=light, kind="moving")]
    table = pd.concat(found, ignore_index=True).assign(scene=name)
    table.to_csv(folder / "winners.csv", index=False)
    return table


def measure(folder: Path = HERE, names: Sequence[str] | None = None) -> pd.DataFrame:
    """Winners of every scene, a row per scene, light, kind (still or moving), budget, error and method, best first."""
    here = places()
    tables = []
    for name in here if names is None else names:
        tables.append(measure_one(name, here[name].make(), folder / name.replace("/", "_").replace(" ", "_")))
        print(f"{name}\n{table_of_winners(tables[-1]).to_string(index=False)}", flush=True)
    found = pd.concat(tables, ignore_index=True)
    found.to_csv(folder / "winners.csv", index=False)
    (folder / "winners.md").write_text(as_markdown(found))
    return found


def chart(found: pd.DataFrame) -> Figure:
    return who_wins(found)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", help=f"of {', '.join(places())}; all where none is named")
    measure(names=parser.parse_args().scene or None)


if __name__ == "__main__":
    main()
