"""What surrounds the pictures: loading, starting, studying."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from unittest import mock

import interreflect as ir
from bench.counted import NOTES, CountedAmbient, noted
from bench.rows import Row, absent, within
from bench.sponza import PATH
from bench.timing import least, timed
from interreflect.scenes.load import find
from interreflect.study.store import Store

ROOT = Path(__file__).resolve().parent.parent
MEBIBYTES = 600.0


def rows() -> list[Row]:
    return [study_overhead(), records_loading(), *start_rows(), *loading_rows()]


def study_overhead(cells: int = 60) -> Row:
    """Wall time of a study's cells outside the frames and the metrics, its truth made and its worker started before."""
    scene, reference = ir.scenes.cornell_box(), ir.Reference(noise=0.5, max_spp=16)

    def study(name: str, seeds: range) -> ir.Study:
        return ir.Study(
            name=name, scenes=[scene], methods=[CountedAmbient()], size=(160, 90), seeds=seeds, reference=reference, repeats=2,
            max_repeats=2,
        )  # fmt: skip

    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        notes = Path(folder) / "notes"
        stack.enter_context(mock.patch.dict(os.environ, {"INTERREFLECT_CACHE": folder, NOTES: str(notes)}))
        ir.run(study("first", range(cells, cells + 1)), Path(folder) / "study")
        start, before = time.perf_counter(), noted(notes)
        records = ir.run(study("overhead", range(cells)), Path(folder) / "study")
        own = time.perf_counter() - start - (noted(notes) - before)
    if not (records.table["status"] == "ok").all():
        raise RuntimeError(f"a cell of the study failed: {records.table['failure'].dropna().tolist()}")
    return within("study layer, a cell", 1e3 * own / cells, None, 5, note=f"mean of {cells} cells, pictures kept")


def records_loading(count: int = 10_000) -> Row:
    """Reading the records of a study of many cells, pictures apart."""
    study = ir.Study(
        name="many", scenes=[ir.scenes.cornell_box()], methods=[ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16))], size=(32, 24),
        reference=ir.Reference(noise=0.5, max_spp=16), images=False,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder, mock.patch.dict(os.environ, {"INTERREFLECT_CACHE": folder}):
        store = Store(Path(folder) / "study")
        record = ir.run(study, store.folder)[0]
        copies = [dataclasses.replace(record, key=f"{k:032x}", seed=k) for k in range(count)]
        with mock.patch("os.fsync"):  # ten thousand of them take minutes, and no power is cut here
            for copy in copies:
                store.write(copy)
        store.begin(study.name, [{"key": copy.key, "scene": "many", "camera": "first"} for copy in copies])
        milliseconds = least(timed(lambda: len(ir.load_records(store.folder))), repeats=3)[0]
    return within("10,000 records to load", milliseconds, None, 1000, note="the files are in the system's page cache")


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
