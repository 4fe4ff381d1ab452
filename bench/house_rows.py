"""What surrounds the pictures: loading, starting, studying."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest import mock

import interreflect as ir
import interreflect.study.run as study_run
from bench.rows import Row, absent, within
from bench.sponza import PATH
from bench.timing import least, timed
from interreflect.scenes.load import find

ROOT = Path(__file__).resolve().parent.parent
MEBIBYTES = 600.0


def rows() -> list[Row]:
    return [study_overhead(), *start_rows(), *loading_rows()]


def study_overhead(cells: int = 60) -> Row:
    """Wall time of a study's cells outside the frames and the metrics, its truth made before."""
    scene = ir.scenes.cornell_box()
    spent = [0.0]

    def counted(call: Callable[..., Any]) -> Callable[..., Any]:
        def counting(*given: Any, **named: Any) -> Any:
            start = time.perf_counter()
            try:
                return call(*given, **named)
            finally:
                spent[0] += time.perf_counter() - start

        return counting

    reference = ir.Reference(noise=0.5, max_spp=16)
    seeds = range(cells)
    study = ir.Study(
        name="overhead", scenes=[scene], methods=[ir.methods.ConstantAmbient()], size=(160, 90), seeds=seeds, reference=reference,
        repeats=2, max_repeats=2,
    )  # fmt: skip
    prepared = type(study.methods[0].prepare(scene))
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        stack.enter_context(mock.patch.dict(os.environ, {"INTERREFLECT_CACHE": folder}))
        ir.reference(scene, None, study.size, 1, reference.noise, reference.max_spp)
        stack.enter_context(mock.patch.object(prepared, "render", counted(prepared.render)))
        for metrics in (study_run.ON_IMAGE, study_run.ON_INDIRECT):
            stack.enter_context(mock.patch.dict(metrics, {name: counted(metric) for name, metric in metrics.items()}))
        start = time.perf_counter()
        records = ir.run(study, Path(folder) / "study")
        whole = time.perf_counter() - start
    if not (records.table["status"] == "ok").all():
        raise RuntimeError(f"a cell of the study failed: {records.table['failure'].dropna().tolist()}")
    return within("study layer, a cell", 1e3 * (whole - spent[0]) / cells, None, 5, note=f"mean of {cells} cells, pictures kept")


def start_rows() -> list[Row]:
    commands = {
        "import interreflect": [sys.executable, "-c", "import interreflect"],
        "interreflect --help": [sys.executable, "-c", "import sys; sys.argv[1:] = ['--help']; from interreflect.cli import main; main()"],
    }
    return [within(name, least(timed(lambda c=command: _run(c)), repeats=7)[0], None, 300) for name, command in commands.items()]


def loading_rows() -> list[Row]:
    """Sponza from its files and from the cache to the first ray, in processes of their own, imports included."""
    bounds = {"Sponza to first ray, cold": 3000.0, "Sponza to first ray, cached": 1000.0}
    try:
        path = find(PATH)
    except FileNotFoundError:
        return [absent(name, f"at most {bound:g} ms", "Sponza is not here") for name, bound in bounds.items()]
    cold, cached = [], []
    for _ in range(3):
        with tempfile.TemporaryDirectory() as cache:
            cold.append(_first_ray(path, cache))
            cached.append(_first_ray(path, cache))
    found = []
    for (name, bound), runs in zip(bounds.items(), (cold, cached), strict=True):
        memory = max(run["mebibytes"] for run in runs)
        row = within(name, 1e3 * min(run["seconds"] for run in runs), None, bound, details={"mebibytes": memory})
        found.append(_also_memory(row, memory))
    return found


def _also_memory(row: Row, mebibytes: float) -> Row:
    met = bool(row.met) and mebibytes <= MEBIBYTES
    note = f"peak memory {mebibytes:.0f} MiB; the files are in the system's page cache"
    return dataclasses.replace(row, target=f"{row.target}, at most {MEBIBYTES:g} MiB", met=met, note=note)


def _first_ray(path: str, cache: str) -> dict[str, float]:
    printed = _run([sys.executable, str(Path(__file__).with_name("first_ray.py")), path], INTERREFLECT_CACHE=cache)
    result: dict[str, float] = json.loads(printed.splitlines()[-1])
    return result


def _run(command: list[str], **environment: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT, env={**os.environ, **environment}).stdout
