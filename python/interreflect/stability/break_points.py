"""The atlas: every method on every failure, and where it breaks."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import zipfile
from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect import cache
from interreflect.progress import bar
from interreflect.stability.crossing import BREAKS, REVERSED, Crossing, Point, find, point_of
from interreflect.stability.failure import Failure, Reading
from interreflect.study.files import canonical, replacing
from interreflect.study.sources import source_digest

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

FORMAT = 1
WAITS, FAILED = "waits", "failed"
HERE = Path(__file__).resolve().parent
# Files of this package that decide what is measured; the others decide where, or draw.
MEASURING = (
    "cache_failures.py", "failure.py", "moving_failures.py", "reprojection.py", "similar.py", "still_failures.py", "temporal.py",
    "virtual_light_failures.py", "voxel_failures.py",
)  # fmt: skip


@dataclasses.dataclass(frozen=True, eq=False)
class Cell:
    """A method on a failure. outcome: as of Crossing, or "waits" (for a stage) or "failed"; words: what there is to say about it."""

    method: str
    failure: Failure
    outcome: str
    words: str
    crossing: Crossing | None = None
    voxels: int | None = None  # along the longest side, of methods whose grid has voxels of one size over the scene's bounds

    @property
    def text(self) -> str:
        """The break point as people read it."""
        if self.crossing is None or self.outcome not in (BREAKS, REVERSED):
            return self.words
        c, unit = self.crossing, f" {self.failure.unit}" if self.failure.unit else ""
        text = f"{c.value:.3g}{unit} [{c.low:.3g}, {c.high:.3g}]"
        if not math.isnan(self.in_voxels):
            text += f" = {self.in_voxels:.2g} voxels"
        return f"{text}, {c.words}" if c.words else text

    @property
    def in_voxels(self) -> float:
        """The break point in voxels of the method's grid, where its unit is extents and the method has one; else NaN."""
        if self.crossing is None or self.voxels is None or self.failure.unit != "extents":
            return math.nan
        return self.crossing.value * self.voxels


@dataclasses.dataclass(frozen=True, eq=False)
class Atlas:
    """Break points of methods."""

    cells: tuple[Cell, ...]

    @cached_property
    def break_points(self) -> pd.DataFrame:
        """A row per method and failure: outcome, break point with its 95 % interval, unit, the same in voxels, tolerance, words."""
        import pandas as pd

        nothing = (math.nan,) * 3
        rows = []
        for cell in self.cells:
            c = cell.crossing
            value, low, high = (c.value, c.low, c.high) if c is not None else nothing
            rows.append({
                "method": cell.method, "failure": cell.failure.name, "outcome": cell.outcome, "break_point": value,
                "low": low, "high": high,
                "unit": cell.failure.unit, "voxels": cell.in_voxels, "easy": cell.failure.easy, "hard": cell.failure.hard,
                "tolerance": cell.failure.tolerance, "words": cell.words,
            })  # fmt: skip
        return pd.DataFrame(rows).set_index(["method", "failure"])

    @cached_property
    def table(self) -> pd.DataFrame:
        """Failures by methods: the break point in words."""
        import pandas as pd

        rows = [{"failure": cell.failure.name, "method": cell.method, "text": cell.text} for cell in self.cells]
        table = pd.DataFrame(rows).pivot(index="failure", columns="method", values="text")
        return table.reindex(index=list(self.failures), columns=list(self.methods))

    @property
    def methods(self) -> list[str]:
        return list(dict.fromkeys(cell.method for cell in self.cells))

    @property
    def failures(self) -> dict[str, Failure]:
        return {cell.failure.name: cell.failure for cell in self.cells}

    def cell(self, method: str, failure: str) -> Cell:
        """KeyError where there is none."""
        for cell in self.cells:
            if (cell.method, cell.failure.name) == (method, failure):
                return cell
        raise KeyError((method, failure))

    def chart(self, dark: bool = False) -> Figure:
        """Break points along each failure's sweep, a colour per method."""
        from interreflect.charts.stability import break_points

        return break_points(self, dark)

    def leak_against_occlusion(self, dark: bool = False) -> Figure:
        """Leaks through walls against over-occlusion, a point per method: neither alone ranks."""
        from interreflect.charts.stability import leak_against_occlusion

        return leak_against_occlusion(self, dark)

    def save(self, path: str | Path) -> Path:
        """Writes the page: failures by methods, break points, charts, pictures before and after. One file, no network."""
        from interreflect.stability.page import page

        target = Path(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(page(self), encoding="utf-8")
        return target

    def _repr_html_(self) -> str:
        return str(self.table.to_html(na_rep=""))


def atlas(
    methods: Sequence[Any] | Mapping[str, Any],
    failures: Iterable[Failure] | None = None,
    seeds: Iterable[int] = range(3),
    sweep: int = 6,
    bisections: int = 4,
    folder: str | Path | None = None,
    threads: int | None = None,
) -> Atlas:
    """Sweeps each failure's knob with each method, brackets and bisects its break point.

    methods: by name, or named after the knobs that tell them apart. failures: None: all of `ir.stability.failures`.
    seeds: at least two give an interval from noise. sweep: values of the first pass. folder: where every measured setting is kept, so
    that an interrupted atlas resumes (None: the user's cache). A method that raises is a cell that says so. ValueError for no methods
    or for a sweep of fewer than two values.
    """
    from interreflect.stability import failures as all_failures

    rows, numbers = tuple(all_failures if failures is None else failures), tuple(seeds)
    if not methods or not rows or not numbers or sweep < 2:
        raise ValueError("atlas needs at least one method, one failure, one seed and a sweep of two values")
    store = _Store(cache.folder("atlas") if folder is None else Path(folder), numbers, threads)
    pairs = [(name, method, row) for row in rows for name, method in labels(methods).items()]
    cells = []
    with bar(pairs, desc="atlas", unit="cell") as progress:
        for name, method, row in progress:
            progress.set_postfix_str(f"{row.name}: {name}")
            cells.append(_cell(store, name, method, row, sweep, bisections))
    return Atlas(tuple(cells))


def labels(methods: Sequence[Any] | Mapping[str, Any]) -> dict[str, Any]:
    """A name for each method: the given one; else its own, with the knobs in which it differs from its defaults where methods share it."""
    if isinstance(methods, Mapping):
        return dict(methods)
    named: dict[str, Any] = {}
    kinds = [type(method) for method in methods]
    for method in methods:
        name = method.name
        if kinds.count(type(method)) > 1:
            plain = type(method)().knobs()
            changed = [f"{path.rpartition('.')[2]} {value}" for path, value in method.knobs().items() if plain.get(path) != value]
            name = f"{name} {', '.join(changed)}".strip()
        if name in named:
            raise ValueError(f"two methods are the same: {name}")
        named[name] = method
    return named


def _cell(store: _Store, name: str, method: Any, row: Failure, sweep: int, bisections: int) -> Cell:
    if row.waits:
        return Cell(name, row, WAITS, row.waits)
    try:
        crossing = find(row, lambda value: store.point(method, row, value), sweep, bisections)
    except Exception as error:
        return Cell(name, row, FAILED, f"{type(error).__name__}: {error}")
    return Cell(name, row, crossing.outcome, crossing.words, crossing, _voxels(method))


def _voxels(method: Any) -> int | None:
    """Voxels along the scene's longest side; None where they are not of one size, or not fitted to the scene."""
    knobs = method.knobs()
    even = {"grid.warp": "Linear", "grid.cascades": 1, "grid.region": "SceneBounds"}
    return knobs.get("grid.resolution") if all(knobs.get(path, value) == value for path, value in even.items()) else None


@dataclasses.dataclass(frozen=True)
class _Store:
    """Points that were measured, one file each; a damaged file is measured again."""

    folder: Path
    seeds: tuple[int, ...]
    threads: int | None

    def point(self, method: Any, row: Failure, value: float) -> Point:
        path = self.folder / f"{self._key(method, row, value)}.npz"
        readings = self._load(path)
        if readings is None:
            readings = [row.read(method, value, seed, self.threads) for seed in self.seeds]
            self._save(path, readings)
        return point_of(value, readings)

    def _key(self, method: Any, row: Failure, value: float) -> str:
        scene = row.scene(value)
        identity = {
            "format": FORMAT,
            "sources": source_digest(method.__class__, *(HERE / name for name in MEASURING), *sorted((HERE / "measures").glob("*.py"))),
            "method": [method.name, {path: str(knob) for path, knob in method.knobs().items()}],
            "failure": [row.name, value, row.camera, list(row.size)],
            "scene": [scene.hash, {name: dataclasses.asdict(camera) for name, camera in scene.cameras.items()}],
            "seeds": list(self.seeds),
        }
        return hashlib.sha256(canonical(identity).encode()).hexdigest()[:32]

    def _load(self, path: Path) -> list[Reading] | None:
        try:
            with np.load(path, allow_pickle=False) as kept:
                image, truth = kept["image"].astype(np.float32), kept["truth"].astype(np.float32)
                numbers = kept["numbers"]
        except (OSError, KeyError, ValueError, EOFError, zipfile.BadZipFile):
            return None
        shown = truth if truth.size else None
        return [Reading(float(error), image, shown, float(signed), float(floor)) for error, signed, floor in numbers]

    def _save(self, path: Path, readings: Sequence[Reading]) -> None:
        first = readings[0]
        truth = np.zeros(0) if first.truth is None else first.truth
        with replacing(path, sync=False) as file:
            # Pictures are for the eye: half floats.
            small = [np.clip(image, -6e4, 6e4).astype(np.float16) for image in (first.image, truth)]
            numbers = np.array([(reading.error, reading.signed, reading.floor) for reading in readings])
            np.savez_compressed(file, allow_pickle=False, image=small[0], truth=small[1], numbers=numbers)
