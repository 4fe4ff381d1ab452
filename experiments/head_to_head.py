"""Voxel cones, clustered caches, virtual area lights or denoised paths: which is nearest to one bounce within a time, where, and why?

`python -m experiments.head_to_head [scene ...] [--only records]` measures what is missing, scene by scene, and prints who wins; records,
tables, charts and a page lie in a folder of each scene's name, the pages with the ladder of mechanisms, the stages' shares of the best
virtual lights' error, and advice. `./run figures head_to_head` draws errors against time of all scenes. Black may win by relMSE, which
is why FLIP stands beside it. A scene that is not here is left out and said so.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import FOLDER
from experiments.shared.panels import as_light, panels
from experiments.shared.rivals import BLACK, PLACES, Place, rivals, rungs
from interreflect.charts import axis_label
from interreflect.charts.records import few_ticks
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure
from interreflect.study.configurations import NOISE_OF, configurations

__all__ = ["chart", "measure"]

HERE = FOLDER / "head_to_head"
SIZE, SEEDS = (320, 180), (0, 1, 2)
NOISE = 5e-4  # of the truth, relMSE, where it is reached within the scene's samples
BUDGETS = (50, 200, 1000)  # ms
ERRORS = ("relmse", "flip")
OURS = "virtual-area-lights"
# Why, at a quarter of the pixels or less: exact counterparts of all lights at every pixel, and hundreds of settings around the advised one.
LADDER, SHARES = (160, 90), (80, 45)
LIGHTS = 512  # that stand for all texels of the lights' maps
BUDGET_OF_ADVICE = 200.0  # ms


@dataclass(frozen=True)
class Why:
    """What explains a scene's winner."""

    shares: Any  # of the stages, in the error of the best virtual area lights
    advice: Any  # with its ladder


def study(name: str, scene: ir.Scene, place: Place) -> ir.Study:
    """Two timed frames of three seeds each: six, the fewest of whose median an interval is known."""
    return ir.Study(
        name=f"head to head: {name}", scenes=[scene], cameras=[place.camera], methods=list(rivals().values()), size=SIZE, seeds=SEEDS,
        bounces=1, reference=ir.Reference(noise=NOISE, max_spp=place.spp), repeats=2, max_repeats=2,
    )  # fmt: skip


def folder_of(name: str, folder: Path) -> Path:
    return folder / name.lower().replace("'", "").replace(" ", "_")


def scenes(names: Sequence[str] = tuple(PLACES)) -> dict[str, ir.Scene]:
    """Those that are here."""
    found = {}
    for name in names:
        try:
            found[name] = PLACES[name].make()
        except FileNotFoundError as error:
            print(f"{name}: left out, the scene is not here: {error}", flush=True)
    return found


def measure(folder: Path = HERE, names: Sequence[str] = tuple(PLACES)) -> Mapping[str, ir.Records]:
    """Records by scene; tables, charts and pictures of each in its folder."""
    found = {}
    for name, scene in scenes(names).items():
        kept = folder_of(name, folder)
        found[name] = ir.run(study(name, scene, PLACES[name]), kept / "records")
        winners(found[name]).to_csv(kept / "winners.csv", index=False)
        speed_accuracy({name: found[name]}).savefig(kept / "speed_accuracy.png", dpi=110)
        pictures(found[name]).savefig(kept / "pictures.png", dpi=80)
    return found


def winners(records: ir.Records) -> pd.DataFrame:
    """Within each budget and by each error, every method's best setting with its interval, best first. `beats_black`: of direct light
    alone; `note`: "within noise" where the error, or how far the next one is behind, is no more than the truth's noise or the intervals."""
    rows = []
    for milliseconds in BUDGETS:
        for y in ERRORS:
            ranked = ir.equal_time(records, milliseconds=milliseconds, y=y)
            for place, (_, row) in enumerate(ranked.iterrows(), 1):
                rows.append(
                    {"budget": milliseconds, "by": y, "place": place, "method": row["method"], "setting": setting(records, row)}
                    | {name: row[name] for error in ERRORS for name in (error, f"{error}_low", f"{error}_high")}
                    | {"milliseconds": row["milliseconds"], "beats_black": row[y] < black(records)[y], "note": row["note"]}
                )
    return pd.DataFrame(rows)


def setting(records: ir.Records, row: Any) -> str:
    """Its name among the rivals, whose records lie in their order, each seed after the other."""
    place = [record.configuration for record in records].index(row["configuration"])
    return list(rivals())[place // (len(records) // len(rivals()))]


def pictures(records: ir.Records) -> Figure:
    """Every setting's first picture and the truth, at the truth's exposure."""
    truth = records.truth(records[0])[0]
    shown = [("truth of one bounce", as_light(truth, truth))]
    for index, name in enumerate(rivals()):
        record = records[index * (len(records) // len(rivals()))]
        title = f"{name}: {record.milliseconds:.0f} ms, FLIP {record.metrics['flip']:.3f}, relMSE {record.metrics['relmse']:.3f}"
        shown.append((title, as_light(records.images(record)[0], truth)))
    return panels(shown, columns=4)


def black(records: ir.Records) -> pd.Series:
    """The row of direct light alone."""
    return configurations(records).iloc[list(rivals()).index(BLACK)]


def explain(name: str, folder: Path, records: ir.Records) -> Why:
    """Stage by stage, the error of the virtual lights that are best within the largest budget; the ladder of mechanisms; advice."""
    scene, place, kept = PLACES[name].make(), PLACES[name], folder_of(name, folder)
    reference = ir.Reference(noise=NOISE, max_spp=place.spp)
    best = ir.equal_time(records, milliseconds=BUDGETS[-1])
    best = best[best["method"] == OURS].iloc[0]
    method = rivals()[setting(records, best)]
    shares = ir.attribute(
        method, scene, place.camera, SHARES, seeds=SEEDS, samples=LIGHTS, reference=reference, folder=kept / "attribution"
    )  # fmt: skip
    advice = ir.advise(
        scene, place.camera, LADDER, milliseconds=BUDGET_OF_ADVICE, reference=reference, folder=kept / "advice", rungs=rungs()
    )  # fmt: skip
    ir.report(records, kept / "page.html", advice.ladder, shares, advice)
    (kept / "why.txt").write_text(f"{advice.ladder}\n\n{shares}\n\n{advice}\n")
    return Why(shares, advice)


def speed_accuracy(found: Mapping[str, ir.Records]) -> Figure:
    """A row per scene: relMSE and FLIP against a frame's time, a line per method through what none of its other settings beats."""
    figure = new_figure((9.0, 3.2 * len(found)), dark=False)
    panels = figure.subplots(len(found), len(ERRORS), squeeze=False)
    for row, (name, records) in zip(panels, found.items(), strict=True):
        for axes, y in zip(row, ERRORS, strict=True):
            _draw(axes, records, y)
            axes.set(title=name, xscale="log", yscale="log", xlabel=axis_label("milliseconds"), ylabel=axis_label(y))
            few_ticks(axes, also_y=True)
            dress(axes, dark=False)
    add_legend(figure, panels.flat, dark=False)
    return figure


def _draw(axes: Axes, records: ir.Records, y: str) -> None:
    table, baseline = configurations(records), black(records)
    noise = baseline.get(NOISE_OF.get(y, ""))
    for (name, points), colour, marker in zip(table.groupby("method", sort=False), COLOURS, MARKERS, strict=False):
        if name == baseline["method"]:
            axes.axhline(baseline[y], color="grey", linestyle="--", linewidth=0.8, label=BLACK)
            continue
        level = points[y] if noise is None else points[y].clip(lower=noise / 2)  # a logarithm has no 0
        reach = ((points[f"{y}_high"] - points[f"{y}_low"]) / 2).clip(upper=0.9 * level)
        style: Any = {"color": colour, "marker": marker, "markersize": 4, "linestyle": "none", "elinewidth": 0.8}
        axes.errorbar(points["milliseconds"], level, yerr=reach, label=str(name), **style)
        front = level[points.sort_values("milliseconds").index].cummin().drop_duplicates()
        axes.step(points.loc[front.index, "milliseconds"], front, where="post", color=colour, linewidth=0.8)
    if noise is not None:
        axes.axhline(noise, color="grey", linestyle=":", linewidth=0.8, label="the truth's noise")


def chart(found: Mapping[str, ir.Records]) -> Figure:
    return speed_accuracy(found)


def told(name: str, records: ir.Records) -> str:
    table = winners(records)
    firsts = table[table["place"] == 1]
    lines = [f"\n## {name}: the truth's noise {records[0].noise:.1e}, direct light alone relMSE {black(records)['relmse']:.4g}"]
    lines += [
        f"within {row['budget']} ms by {row['by']}: {row['setting']}{f' ({row.note})' if row['note'] else ''}"
        for _, row in firsts.iterrows()
    ]
    return "\n".join([*lines, table.to_string(index=False, float_format=lambda number: f"{number:.4g}")])


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", default=list(PLACES), help=", ".join(PLACES))
    parser.add_argument("--only", choices=("records",), help="leave out why: ladder, attribution and advice")
    given = parser.parse_args()
    for name, records in measure(names=given.scene).items():
        print(told(name, records), flush=True)
        if given.only is None:
            print(f"\n{(kept := explain(name, HERE, records)).advice.ladder}\n{kept.shares}\n{kept.advice}", flush=True)


if __name__ == "__main__":
    main()
