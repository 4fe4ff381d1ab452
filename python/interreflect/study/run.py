"""Run a study: measure every cell that its folder does not hold yet."""

from __future__ import annotations

import dataclasses
import hashlib
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from interreflect import metrics
from interreflect.machine import about
from interreflect.study.files import canonical
from interreflect.study.interface import Frame, Method, Prepared, Scene
from interreflect.study.records import FAILED, NOT_FINITE, OK, Record, Records
from interreflect.study.reference import Truth, reference, reference_key
from interreflect.study.sources import PACKAGE, source_digest
from interreflect.study.store import FORMAT, Store, load_records
from interreflect.study.study import Cell, Study
from interreflect.study.timing import measure
from interreflect.study.writer import Writer

Metric = Callable[[Any, Any], float]
ON_IMAGE: dict[str, Metric] = {
    "relmse": metrics.relmse,
    "trimmed_relmse": metrics.trimmed_relmse,
    "energy_ratio": metrics.energy_ratio,
    "flip": metrics.flip,
    "ssim": metrics.ssim,
    "hue_shift": metrics.hue_shift,
}
DECISIVE = ("numpy", "pyoidn", "flip-evaluator", "scikit-image")  # libraries that can change a number of a record
ON_INDIRECT: dict[str, Metric] = {
    "indirect_relmse": metrics.relmse,
    "indirect_trimmed_relmse": metrics.trimmed_relmse,
    "indirect_energy_ratio": metrics.energy_ratio,
}


def run(study: Study, folder: str | Path, timeout: float | None = None, memory: int | None = None, client: Any = None) -> Records:
    """Measure a study into a folder, one file per cell, and return its records.

    What the folder holds already is not measured again; a study that was interrupted or killed resumes. A method that raises
    and a picture with numbers that are not finite are rows of the table. Cells are timed one after the other in this process;
    timeout, memory and client must be None: limits per cell need processes of their own, which this version does not start.
    """
    for name, value in (("timeout", timeout), ("memory", memory), ("client", client)):
        if value is not None:
            raise ValueError(f"run: {name} must be None, as cells run in this process without limits, got {value!r}")
    from tqdm import tqdm

    store = Store(folder)
    cells = study.cells()
    keys = [cell_key(study, cell) for cell in cells]
    labels = scene_labels(study)
    listed = [{"key": k, "scene": labels[c.scene.hash], "camera": c.camera} for k, c in zip(keys, cells, strict=True)]
    store.begin(study.name, listed)
    # Scene by scene and method by method, so that cameras and seeds share one preparation.
    order = {(c.scene.hash, id(c.method)): i for i, c in reversed(list(enumerate(cells)))}
    planned = sorted(range(len(cells)), key=lambda i: (order[cells[i].scene.hash, id(cells[i].method)], i))
    with Writer(store) as writer, tqdm(planned, desc=study.name, unit="cell", disable=None) as progress:
        bench = _Bench(study, writer)
        for index in progress:
            cell, key = cells[index], keys[index]
            progress.set_postfix_str(f"{labels[cell.scene.hash]} {cell.method.name}")
            if store.read(key) is None:
                writer.record(bench.measure(cell, key))
    return load_records(folder)


def cell_key(study: Study, cell: Cell) -> str:
    """Hash of everything that determines a cell's record: what is rendered, how it is timed, by which code, on which machine."""
    machine = about()
    identity = {
        "format": FORMAT,
        "scene": cell.scene.hash,
        "camera": dataclasses.asdict(cell.scene.cameras[cell.camera]),
        "method": cell.method.name,
        "knobs": {name: plain(value) for name, value in cell.method.knobs().items()},
        "seed": cell.seed,
        "size": list(study.size),
        "bounces": cell.bounces,
        "reference": dataclasses.asdict(study.reference),
        "threads": study.threads or machine.threads,
        "repeats": [study.repeats, study.max_repeats],
        "images": study.images,
        "sources": source_digest(type(cell.method), PACKAGE / "metrics.py"),
        "machine": [machine.processor, machine.compiler, machine.python, [machine.libraries.get(name) for name in DECISIVE]],
    }
    return hashlib.sha256(canonical(identity).encode()).hexdigest()[:32]


def plain(value: Any) -> Any:
    """A knob's value as JSON has it; techniques by their repr."""
    if isinstance(value, np.generic):
        value = value.item()
    return value if value is None or isinstance(value, bool | int | str | float) else repr(value)


def scene_labels(study: Study) -> dict[str, str]:
    """Hash -> name of each scene; the hash's first letters where a name is absent or taken."""
    names = [scene.name for scene in {scene.hash: scene for scene in study.scenes}.values()]
    return {
        scene.hash: scene.name if scene.name and names.count(scene.name) == 1 else f"{scene.name} {scene.hash[:8]}".strip()
        for scene in study.scenes
    }


class _Bench:
    """Measures cells one by one; keeps the preparation and the truths of the scene at hand."""

    def __init__(self, study: Study, writer: Writer) -> None:
        self.study, self.writer = study, writer
        self.threads = study.threads or about().threads
        self.machine = about().asdict()
        self._prepared: tuple[tuple[str, Method], Prepared] | None = None
        self._truths: tuple[str, dict[str, Truth]] = ("", {})

    def measure(self, cell: Cell, key: str) -> Record:
        """The cell's record, its pictures given to the writer; what fails becomes a record that says so."""
        record = self._describe(cell, key)
        try:
            truth = self._truth(cell)
        except Exception as error:
            return dataclasses.replace(record, status=FAILED, failure=f"reference: {_words(error)}")
        record = dataclasses.replace(record, noise=truth.noise, indirect_noise=truth.indirect_noise, truth=truth.key, truth_spp=truth.spp)
        try:
            prepared = self._prepare(cell.scene, cell.method)
            frame, timing = measure(
                lambda: prepared.render(cell.camera, size=self.study.size, seed=cell.seed, threads=self.study.threads),
                self.study.repeats,
                self.study.max_repeats,
                before_clock=self.writer.settle,
            )
            record = dataclasses.replace(
                record, precompute_milliseconds=float(prepared.precompute_milliseconds), **dataclasses.asdict(timing)
            )
            if frame.image.shape != truth.image.shape:
                raise ValueError(f"the picture's shape must be {truth.image.shape}, got {frame.image.shape}")
        except Exception as error:
            return dataclasses.replace(record, status=FAILED, failure=_words(error))
        if self.study.images:
            self.writer.pictures(key, frame, truth)
        try:
            return self._compare(dataclasses.replace(record, images=self.study.images), frame, truth)
        except Exception as error:
            return dataclasses.replace(record, status=FAILED, failure=_words(error))

    def _describe(self, cell: Cell, key: str) -> Record:
        warnings = list(cell.scene.warnings)
        if cell.bounces != cell.method.bounces:
            made, wanted = ("all" if n is None else n for n in (cell.method.bounces, cell.bounces))
            warnings.append(f"the method makes {made} indirect bounces, the truth has {wanted}")
        return Record(
            key=key,
            scene=cell.scene.name,
            scene_hash=cell.scene.hash,
            camera=cell.camera,
            camera_values=dataclasses.asdict(cell.scene.cameras[cell.camera]),
            method=cell.method.name,
            knobs={name: plain(value) for name, value in cell.method.knobs().items()},
            seed=cell.seed,
            size=self.study.size,
            bounces=cell.bounces,
            threads=self.threads,
            machine=self.machine,
            warnings=tuple(warnings),
        )

    def _truth(self, cell: Cell) -> Truth:
        wanted, size = self.study.reference, self.study.size
        if self._truths[0] != cell.scene.hash:
            self._truths = (cell.scene.hash, {})
        kept = self._truths[1]
        key = reference_key(cell.scene, cell.camera, size, cell.bounces, wanted, 0)
        if key not in kept:
            kept[key] = reference(cell.scene, cell.camera, size, cell.bounces, wanted.noise, wanted.max_spp, threads=self.study.threads)
        return kept[key]

    def _prepare(self, scene: Scene, method: Method) -> Prepared:
        if self._prepared is None or self._prepared[0][0] != scene.hash or self._prepared[0][1] is not method:
            self._prepared = None  # the memory of the last one is free before the next one takes its own
            self._prepared = ((scene.hash, method), method.prepare(scene, threads=self.study.threads))
        return self._prepared[1]

    def _compare(self, record: Record, frame: Frame, truth: Truth) -> Record:
        """The record with status and metrics; a metric that this picture cannot have is NaN, with the reason as a warning."""
        image, indirect = frame.image, frame.indirect
        wrong = sum(int(light.size - np.count_nonzero(np.isfinite(light))) for light in (image, indirect))
        if wrong:
            failure = f"{wrong} numbers of the picture are not finite"
            return dataclasses.replace(record, status=NOT_FINITE, failure=failure)
        pairs = [(name, metric, image, truth.image) for name, metric in ON_IMAGE.items()]
        pairs += [(name, metric, indirect, truth.indirect) for name, metric in ON_INDIRECT.items()]
        values, reasons = {}, []
        for name, metric, light, target in pairs:
            try:
                values[name] = metric(light, target)
            except ValueError as error:
                values[name] = math.nan
                reasons.append(f"{name}: {error}")
        return dataclasses.replace(record, status=OK, metrics=values, warnings=(*record.warnings, *reasons))


def _words(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
