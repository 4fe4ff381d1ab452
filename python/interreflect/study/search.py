"""Search over knobs: which settings are worth having, found by measuring few of them. Every trial is a record."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.study.interface import Scene
from interreflect.study.measured import measured, same, study_folder
from interreflect.study.records import OK, Record, Records
from interreflect.study.reference import Reference
from interreflect.study.space import Axis, axes_of
from interreflect.study.study import Study

if TYPE_CHECKING:
    import pandas as pd

BATCH = 8  # trials that are asked for together: they share the start of a worker process
SMALLER = 3  # the first look is at a picture with sides a third as long
LEAST_SIDE = 24  # pixels: pictures that would be smaller are measured at full size at once
MARGIN = 1.5  # beaten by so much in time and error at the small size, a setting is hopeless
SMALL_NOISE = 5e-3  # of the truth at the small size
Point = tuple[float, float]  # milliseconds, relMSE


@dataclasses.dataclass(frozen=True, eq=False)
class Search:
    """What a search measured. records: trials at full size. pruned: records at the small size of those that looked hopeless there."""

    records: Records
    pruned: tuple[Record, ...]
    failed: int

    @property
    def table(self) -> pd.DataFrame:
        """A row per setting that was measured at full size."""
        from interreflect.study.configurations import configurations

        return configurations(self.records)

    def __repr__(self) -> str:
        return f"<Search: {len(self.records)} records, {len(self.pruned)} settings pruned at a small size, {self.failed} failed>"

    def _repr_html_(self) -> str:
        return f"<p>{self!r}</p>{self.table.to_html(index=False, max_rows=40)}"


def search(
    study: Study,
    trials: int = 32,
    ranges: Mapping[str, Any] | None = None,
    knobs: Sequence[str] | None = None,
    folder: str | Path | None = None,
    milliseconds: float = math.inf,
    relmse: float = math.inf,
    seed: int = 0,
) -> Search:
    """Search the knobs of a study's methods for little time and little error at once, view by view and method by method.

    `trials` settings of each method, the first its own, the others proposed by Optuna's multi-objective TPE [Ozaki et al. 2020] over
    `ranges` (see `axes_of`). Each is looked at in a small picture first and pruned where another one beats it there by half in both
    time and error, where it is over `milliseconds` already, or slower than a setting that keeps `relmse`. Trials are records in
    `folder` (None: the user's cache): the same search goes through them again without measuring. ImportError without the extra `search`.
    """
    names = [(scene, camera) for scene in study.scenes for camera in (study.cameras or list(scene.cameras)[:1]) if camera in scene.cameras]
    records: list[Record] = []
    pruned: list[Record] = []
    failed = 0
    folder = study_folder("search", study.scenes[0], study.name, study.size) if folder is None else Path(folder)
    for scene, camera in names:
        view = _View(study, scene, camera, folder, milliseconds, relmse)
        for method in study.methods:
            of_it = method.knobs()
            own = {path: given for path, given in (ranges or {}).items() if path in of_it}
            view.explore(method, axes_of(method, own, None if knobs is None else [path for path in knobs if path in of_it]), trials, seed)
        records += view.records
        pruned += view.pruned
        failed += view.failed
    return Search(Records(study.name, tuple(records), folder), tuple(pruned), failed)


class _View:
    """The trials on one view of one scene."""

    def __init__(self, study: Study, scene: Scene, camera: str, folder: Path, milliseconds: float, relmse: float) -> None:
        self.study = dataclasses.replace(study, scenes=[scene], cameras=[camera])
        self.folder, self.milliseconds, self.relmse = folder, milliseconds, relmse
        self.records: list[Record] = []  # at full size
        self.known: list[tuple[Point | None, Point]] = []  # of those: at the small size, and at full size
        self.pruned: list[Record] = []
        self.failed = 0
        side: tuple[int, int] = (study.size[0] // SMALLER, study.size[1] // SMALLER)
        small = dataclasses.replace(Reference(), noise=max(SMALL_NOISE, study.reference.noise), max_spp=study.reference.max_spp)
        self.small = (
            dataclasses.replace(self.study, size=side, seeds=study.seeds[:1], repeats=1, max_repeats=3, images=False, reference=small)
            if min(side) >= LEAST_SIDE
            else None
        )

    def explore(self, method: Any, axes: Sequence[Axis], trials: int, seed: int) -> None:
        optuna = _optuna()
        sampler = optuna.samplers.TPESampler(seed=seed, n_startup_trials=max(4, min(10, trials // 3)))
        asked = optuna.create_study(directions=["minimize", "minimize"], sampler=sampler)
        asked.enqueue_trial({axis.path: axis.value for axis in axes if axis.choices or axis.low <= axis.value <= axis.high})
        tried: dict[str, tuple[Any, list[float] | None]] = {}
        for start in range(0, trials, BATCH):
            batch = [asked.ask() for _ in range(min(BATCH, trials - start))]
            methods = [method.replace({axis.path: _suggested(trial, axis) for axis in axes}) for trial in batch]
            new = list({same(made): made for made in methods if same(made) not in tried}.values())
            tried |= zip((same(made) for made in new), self._measure(new), strict=True)
            for trial, made in zip(batch, methods, strict=True):
                state, values = tried[same(made)]
                asked.tell(trial, values, state=getattr(optuna.trial.TrialState, state))

    def _measure(self, methods: list[Any]) -> list[tuple[str, list[float] | None]]:
        """State and objectives of each: the logarithms of time and error."""
        if not methods:
            return []
        looks: list[tuple[Record, ...] | None] = [None] * len(methods)
        if self.small is not None:
            looks = list(measured(dataclasses.replace(self.small, methods=methods), self.folder))
        points = [None if look is None else _point(look) for look in looks]
        hopeful = [i for i in range(len(methods)) if looks[i] is None or (points[i] is not None and not self._hopeless(points[i]))]
        outcomes: list[tuple[str, list[float] | None]] = [("PRUNED", None)] * len(methods)
        for index, look in enumerate(looks):
            if look is not None and points[index] is None:
                outcomes[index], self.failed = ("FAIL", None), self.failed + 1
            elif look is not None and index not in hopeful:
                self.pruned += look
        if hopeful:
            groups = measured(dataclasses.replace(self.study, methods=[methods[i] for i in hopeful]), self.folder)
            for index, group in zip(hopeful, groups, strict=True):
                point = _point(group)
                self.records += group
                if point is None:
                    outcomes[index], self.failed = ("FAIL", None), self.failed + 1
                    continue
                self.known.append((points[index], point))
                outcomes[index] = ("COMPLETE", [math.log10(point[0]), math.log10(max(point[1], group[0].noise / 2, 1e-12))])
        return outcomes

    def _hopeless(self, small: Point | None) -> bool:
        if small is None:
            return True
        if small[0] > self.milliseconds:
            return True
        for other, full in self.known:
            if other is None:
                continue
            beaten = small[0] > MARGIN * other[0] and small[1] > MARGIN * other[1]
            slower_than_enough = full[1] <= self.relmse < math.inf and small[0] > MARGIN * other[0]
            if beaten or slower_than_enough:
                return True
        return False


def _point(group: Sequence[Record]) -> Point | None:
    """Median time and mean error, the truth's noise subtracted; None where a seed failed."""
    if any(record.status != OK for record in group):
        return None
    error = float(np.mean([record.metrics["relmse"] - record.noise for record in group]))
    return float(np.median([record.milliseconds for record in group])), error


def _suggested(trial: Any, axis: Axis) -> Any:
    if axis.choices:
        return trial.suggest_categorical(axis.path, axis.choices)
    if axis.whole:
        return trial.suggest_int(axis.path, math.ceil(axis.low), math.floor(axis.high), log=axis.logarithmic and math.ceil(axis.low) > 0)
    return trial.suggest_float(axis.path, axis.low, axis.high, log=axis.logarithmic)


def _optuna() -> Any:
    try:
        import optuna
    except ImportError as missing:
        raise ImportError("a search needs Optuna: pip install 'interreflect[search]'") from missing
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    return optuna
