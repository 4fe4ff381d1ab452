"""A study laid out over its folder: which cells are open, what a worker is asked for each, and where the answer goes."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from interreflect.machine import about
from interreflect.progress import bar
from interreflect.study.files import canonical
from interreflect.study.interface import Method, Scene
from interreflect.study.locks import Claims
from interreflect.study.messages import Pictures, Reply, Request
from interreflect.study.records import Record
from interreflect.study.reference import reference_key
from interreflect.study.sources import PACKAGE, package_digest, source_digest
from interreflect.study.store import FORMAT, Store
from interreflect.study.study import Cell, Study
from interreflect.study.workers import Limits
from interreflect.study.writer import Writer

DECISIVE = ("numpy", "pyoidn", "flip-evaluator", "scikit-image")  # libraries that can change a number of a record


class Plan:
    """`with Plan(...) as plan`: the cells of a study, of which this run claims one after the other."""

    def __init__(self, study: Study, folder: Path, limits: Limits) -> None:
        self.study, self.limits, self.store = study, limits, Store(folder)
        self.cells = study.cells()
        self.keys = [cell_key(study, cell) for cell in self.cells]
        self.settled = 0  # cells whose records are there
        self._labels = scene_labels(study)
        self._machine = about().asdict()
        self._truths: dict[tuple[str, str, int | None], str] = {}  # scene, camera, bounces -> key
        self._method: tuple[Method | None, bytes] = (None, b"")  # the last one asked for, pickled

    def __enter__(self) -> Plan:
        cells = zip(self.keys, self.cells, strict=True)
        listed = [{"key": key, "scene": self._labels[cell.scene.hash], "camera": cell.camera} for key, cell in cells]
        self.store.begin(self.study.name, listed)
        with ExitStack() as stack:
            self._claims = Claims(self.store.folder)
            stack.callback(self._claims.close)
            self.writer = stack.enter_context(Writer())
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *failure: Any) -> None:
        self._stack.__exit__(*failure)

    def progress(self) -> Any:
        return bar(total=len(self.cells), desc=self.study.name, unit="cell")

    def open_cells(self) -> Iterator[int | None]:
        """Cells to measure, each claimed before it comes; None where other runs have all that are left, for the caller to wait."""
        waiting = deque(self._order())
        while waiting:
            for _ in range(len(waiting)):
                index = waiting.popleft()
                key = self.keys[index]
                if not self._claims.take(key):
                    waiting.append(index)
                elif self._is_settled(self.store.read(key)):
                    self._claims.leave(key)
                    self.settled += 1
                else:
                    yield index
            if waiting:
                yield None

    def request(self, index: int) -> Request:
        """What a worker is asked; without the scene."""
        cell, study = self.cells[index], self.study
        truth = self._truth_key(cell)
        return Request(
            scene_key=_scene_key(cell.scene),
            camera=cell.camera,
            method=self._pickled(cell.method),
            seed=cell.seed,
            size=study.size,
            bounces=cell.bounces,
            reference=study.reference,
            threads=study.threads,
            repeats=study.repeats,
            max_repeats=study.max_repeats,
            images=study.images,
            truth=truth,
            truth_wanted=study.images and not self.store.has_truth(truth),
            code=package_digest(),
        )

    def scene_of(self, index: int) -> Callable[[], bytes]:
        """Pickles the cell's scene when called."""
        return functools.partial(_pickled, self.cells[index].scene)

    def title(self, index: int) -> str:
        cell = self.cells[index]
        return f"{self._labels[cell.scene.hash]}, {cell.method.name}"

    def keep_pictures(self, index: int, pictures: Pictures) -> None:
        """Write the cell's pictures."""
        self.writer.do(self.store.write_pictures, self.keys[index], pictures)

    def keep(self, index: int, reply: Reply) -> None:
        """Write the cell's record. KeyboardInterrupt where the worker met one, RuntimeError where it cannot measure."""
        if reply.interrupted:
            raise KeyboardInterrupt
        if reply.refused:
            raise RuntimeError(reply.refused)
        if reply.calibration is not None:
            self.writer.do(self.store.write_calibration, reply.calibration)
        self.writer.do(self._write, index, reply.changes)
        self.settled += 1

    def _write(self, index: int, changes: dict[str, Any]) -> None:
        described = self._describe(self.cells[index], self.keys[index])
        warnings = (*described.warnings, *changes.get("warnings", ()))
        self.store.write(dataclasses.replace(described, **{**changes, "warnings": warnings}))
        self._claims.leave(described.key)

    def _truth_key(self, cell: Cell) -> str:
        view = (cell.scene.hash, cell.camera, cell.bounces)
        if view not in self._truths:
            self._truths[view] = reference_key(cell.scene, cell.camera, self.study.size, cell.bounces, self.study.reference, 0)
        return self._truths[view]

    def _pickled(self, method: Method) -> bytes:
        if self._method[0] is not method:
            self._method = (method, _pickled(method))
        return self._method[1]

    def _order(self) -> list[int]:
        """Scene by scene and method by method, so that cameras and seeds share one preparation; methods that share pieces of theirs
        one after the other."""
        groups = [_groups(cell) for cell in self.cells]
        first = {group: i for i, of_cell in reversed(list(enumerate(groups))) for group in of_cell}
        return sorted(range(len(self.cells)), key=lambda i: (*(first[group] for group in groups[i]), i))

    def _is_settled(self, record: Record | None) -> bool:
        """Is there a record, and not one that a limit ended which is wider now?"""
        if record is None:
            return False
        now = dataclasses.asdict(self.limits)
        return not any(now[name] is None or now[name] > limit for name, limit in record.limits.items())

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
            threads=self.study.threads or about().threads,
            machine=self._machine,
            warnings=tuple(warnings),
        )


def _groups(cell: Cell) -> list[tuple[Any, ...]]:
    """What cells have in common, from the scene to the preparation."""
    key = (cell.scene.hash, *getattr(cell.method, "pieces_key", ()))
    return [*(key[:length] for length in range(1, len(key) + 1)), (*key, id(cell.method))]


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


def _scene_key(scene: Scene) -> str:
    """What a worker may take for the same scene: the hash leaves cameras out, but the worker looks them up by name."""
    cameras = {name: dataclasses.asdict(camera) for name, camera in scene.cameras.items()}
    return f"{scene.hash} {hashlib.sha256(canonical(cameras).encode()).hexdigest()[:32]}"


def scene_labels(study: Study) -> dict[str, str]:
    """Hash -> name of each scene; the hash's first letters where a name is absent or taken."""
    names = [scene.name for scene in {scene.hash: scene for scene in study.scenes}.values()]
    return {
        scene.hash: scene.name if scene.name and names.count(scene.name) == 1 else f"{scene.name} {scene.hash[:8]}".strip()
        for scene in study.scenes
    }


def _pickled(value: Scene | Method) -> bytes:
    """With classes and functions of `__main__`, as notebooks define them."""
    import cloudpickle

    return bytes(cloudpickle.dumps(value))
