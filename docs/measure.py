"""Measures what the technique pages chart, into docs/measured: `python -m docs.measure [TECHNIQUE ...]`, all where none is named.

    .venv/bin/python -m docs.measure Tessellation      # cost and error against its main knob
    .venv/bin/python -m docs.measure breaks            # where every technique breaks: the atlas, a technique at a time; resumes

Work is counted, and times are ratios of minima over interleaved frames: they may be measured while others use the machine.
"""

from __future__ import annotations

import argparse
import csv
import io
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import interreflect as ir
from docs.generate.measured import BISECTIONS, BREAKS, FOLDER, SWEEP
from docs.generate.notes import notes_of
from docs.generate.settings import Setting, main_knob, setting_of, techniques
from interreflect.stability.crossing import STUDENT

SIZE = (160, 120)
SEEDS = (0, 1, 2)
TRUTH = ir.Reference(noise=1e-3, max_spp=4096)
TIMED = 5  # frames whose least time counts, interleaved over the values
Row = dict[str, Any]


def machine() -> str:
    """And the last commit that changed what renders."""
    about = ir.about()
    log = ["git", "log", "-1", "--format=%h", "--", ":/cpp", ":/python"]
    commit = subprocess.run(log, cwd=FOLDER, capture_output=True, text=True, check=True).stdout.strip()
    return f"{about.processor}, {about.threads} threads, commit {commit}"


def curve(technique: type) -> list[Row]:
    """A row per value of the main knob: error, its spread, the truth's noise, least times, and every count of every stage."""
    setting, found = setting_of(technique), main_knob(technique)
    assert found is not None
    knob, values = found
    path = setting.path_of(knob)
    if setting.method.knobs()[path] not in values:
        raise ValueError(f"{technique.__name__}: the values of {knob} must hold the one that pictures have, {setting.method.knobs()[path]}")
    truth, settings = setting.truth(SIZE, TRUTH), [setting.replace(knob, value) for value in values]
    made = [one.method.prepare(one.scene) for one in settings]
    least = [float("inf")] * len(values)
    for _ in range(TIMED):
        for index, (one, prepared) in enumerate(zip(settings, made, strict=True)):
            least[index] = min(least[index], one.render(prepared, SIZE).profile.milliseconds)
    rows = []
    for value, one, prepared, milliseconds in zip(values, settings, made, least, strict=True):
        frames = [one.render(prepared, SIZE, seed) for seed in SEEDS]
        errors = [ir.metrics.relmse(getattr(frame, one.part), getattr(truth, one.part)) for frame in frames]
        row = {"knob": knob, "value": value, "default": setting.method.knobs()[path], "seeds": len(SEEDS), "error": np.mean(errors)}
        row |= {"spread": STUDENT[len(SEEDS)] * np.std(errors, ddof=1) / len(SEEDS) ** 0.5, "noise": truth_noise(truth, one)}
        row |= {"frame time": milliseconds, **precompute_time(one, prepared)}
        row |= {
            f"{stage}: {name.replace('_', ' ')}": count
            for stage, done in frames[0].profile.stages.items()
            for name, count in done.counts.items()
        }
        rows.append(row)
    return relative(rows)


def truth_noise(truth: Any, setting: Setting) -> float:
    """The relMSE that the truth itself carries; of direct light that of all light."""
    return float(truth.indirect_noise if setting.part == "indirect" else truth.noise)


def precompute_time(setting: Setting, prepared: Any) -> Row:
    """The least of three, where the technique is part of what is built once."""
    if setting.path not in notes_of("methods", type(setting.method).__name__).head.get("precomputed", []):
        return {}
    again = (setting.method.prepare(setting.scene) for _ in range(2))
    return {"precomputation time": min(one.precompute_milliseconds for one in (prepared, *again))}


def relative(rows: list[Row]) -> list[Row]:
    """Times as ratios to the default's: those of this run alone mean little elsewhere."""
    base = next(row for row in rows if row["value"] == row["default"])
    ratios = {name: [row[name] / base[name] for row in rows] for name in base if name.endswith("time")}
    return [{**row, **{name: ratio[index] for name, ratio in ratios.items()}} for index, row in enumerate(rows)]


def keep(path: Path, rows: Sequence[Row], command: str) -> None:
    out = io.StringIO()
    columns = list(dict.fromkeys(name for row in rows for name in row))
    writer = csv.DictWriter(out, columns, restval=0, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: f"{value:.5g}" if isinstance(value, float) else value for name, value in row.items()} for row in rows)
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"# {machine()}; {command}\n{out.getvalue()}")


def break_points(names: dict[str, type]) -> None:
    """A row per technique and failure that aims at one of its stages: first those whose truth is known, then those that trace it."""
    rows: list[Row] = []
    for quick in (True, False):
        for name, technique in names.items():
            aimed = [row for row in ir.stability.failures if set(row.stages) & set(technique.stages)]  # type: ignore[attr-defined]
            aimed = [row for row in aimed if ("path-traced" not in row.truth) == quick]
            atlas = ir.stability.atlas({name: setting_of(technique).method}, aimed, (0,), SWEEP, BISECTIONS) if aimed else None
            for cell in atlas.cells if atlas else ():
                rows.append({"technique": name, "failure": cell.failure.name, "outcome": cell.outcome, "text": cell.text})
            keep(BREAKS, rows, ".venv/bin/python -m docs.measure breaks")
            print(f"{name}, {len(rows)} break points", flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="techniques, or `breaks`")
    wanted = parser.parse_args(arguments).names
    known = techniques()
    if unknown := set(wanted) - set(known) - {"breaks"}:
        parser.error(f"there is no technique {', '.join(sorted(unknown))}")
    for name in wanted or known:
        if name == "breaks":
            break_points(known)
        elif main_knob(known[name]) is not None:
            keep(FOLDER / f"{name}.csv", curve(known[name]), f".venv/bin/python -m docs.measure {name}")
            print(name, flush=True)


if __name__ == "__main__":
    sys.exit(main())
