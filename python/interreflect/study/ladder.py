"""What does a scene need? From direct light upward one mechanism is added at a time, each with few samples and with more."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from interreflect import metrics
from interreflect.study.interface import Method, Scene
from interreflect.study.measured import measured, study_folder, words
from interreflect.study.records import OK, Record
from interreflect.study.reference import Reference, Truth, camera_name
from interreflect.study.reference import reference as make_truth
from interreflect.study.study import Study
from interreflect.study.uncertainty import mean_interval, median_interval

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

WITHIN_NOISE = "within noise"


@dataclasses.dataclass(frozen=True)
class Mechanism:
    """A way of light that a method may carry or leave out. settings: methods that carry it, fewer to more samples.

    bounces: the indirect bounces whose exact light holds this mechanism and all below it; None where no number of bounces does.
    """

    name: str
    settings: Sequence[Method]
    bounces: int | None = None


@dataclasses.dataclass(frozen=True)
class Rung:
    """One mechanism of a ladder, at the fewest samples beyond which more gained nothing. Errors are relMSE, the truth's noise subtracted.

    gain: by how much it lowers the error of the best rung below, with its 95 % interval over seeds; needed: the gain exceeds noise.
    extra_milliseconds: beyond the highest needed rung below. exact_error: what would remain with this and all below carried exactly.
    """

    mechanism: str
    method: Method
    error: float
    low: float
    high: float
    milliseconds: float
    milliseconds_low: float
    milliseconds_high: float
    gain: float
    gain_low: float
    gain_high: float
    extra_milliseconds: float
    exact_error: float
    needed: bool
    note: str
    settings: tuple[tuple[str, float, float], ...]  # of each setting that was measured: words, relMSE, milliseconds
    records: tuple[Record, ...]


@dataclasses.dataclass(frozen=True, eq=False)
class Ladder:
    """The rungs from the lowest up; `stopped` says in words why there are no more. All against the truth of all bounces."""

    scene: Scene
    camera: str
    size: tuple[int, int]
    rungs: tuple[Rung, ...]
    truth_noise: float
    stopped: str
    folder: Path

    @property
    def needed(self) -> tuple[Rung, ...]:
        """The rungs whose gain exceeds noise."""
        return tuple(rung for rung in self.rungs if rung.needed)

    @property
    def table(self) -> pd.DataFrame:
        """A row per rung."""
        import pandas as pd

        left_out = ("settings", "records", "method")
        rows = [{f.name: getattr(rung, f.name) for f in dataclasses.fields(rung) if f.name not in left_out} for rung in self.rungs]
        return pd.DataFrame(rows).assign(setting=[words(rung.method) for rung in self.rungs])

    def chart(self, dark: bool = False) -> Figure:
        """Error and time of every rung, with what would remain if it were exact."""
        from interreflect.charts.ladder import staircase

        return staircase(self, dark)

    def __repr__(self) -> str:
        lines = [f"{self.scene.name}, {self.camera}: truth's own noise {self.truth_noise:.1e}"]
        for rung in self.rungs:
            verdict = "needed" if rung.needed else "not needed"
            gain = "" if math.isnan(rung.gain) else f"gain {rung.gain:+8.4f}"
            lines.append(
                f"  {rung.mechanism:<20} relMSE {rung.error:8.4f}  {rung.milliseconds:8.1f} ms  {gain:<13}  {verdict}"
                f"{f' ({rung.note})' if rung.note else ''}: {words(rung.method)}"
            )
        return "\n".join([*lines, f"  {self.stopped}"])

    def _repr_html_(self) -> str:
        return f"<p>{self.scene.name}, {self.camera}: {self.stopped}</p>{self.table.to_html(index=False)}"


def mechanisms() -> list[Mechanism]:
    """The mechanisms of light that today's methods carry, from constant ambient light upward."""
    import interreflect as ir
    from interreflect.methods import AmbientOcclusion, ConstantAmbient, PathTracing, PathTracingDenoised, VoxelConeTracing

    def sampled(samples: int) -> dict[str, Any]:
        return {"shadow": ir.TracedShadows(samples=samples), "sky": ir.TracedSky(samples=samples)}

    def cones(resolution: int, count: int, glossy: bool) -> Method:
        known = VoxelConeTracing(grid=ir.Grid(resolution=resolution), march=ir.DiffuseCones(cones=count))
        shadows = known.replace({"shadow": ir.TracedShadows(samples=count // 3)})
        return shadows if glossy else shadows.replace({"glossy": None})

    steps = ((32, 12), (64, 24), (128, 48))
    return [
        Mechanism("direct light", [ConstantAmbient(ambient=0.0, **sampled(n)) for n in (1, 4, 16)], bounces=0),
        Mechanism("constant ambient", [ConstantAmbient(**sampled(n)) for n in (1, 4, 16)]),
        Mechanism("ambient occlusion", [AmbientOcclusion(samples=4 * n, **sampled(n)) for n in (1, 4, 16)]),
        Mechanism("one diffuse bounce", [cones(*step, glossy=False) for step in steps]),
        Mechanism("glossy bounce", [cones(*step, glossy=True) for step in steps], bounces=1),
        Mechanism("two bounces", [PathTracing(bounces=2, spp=n) for n in (4, 16, 64)], bounces=2),
        Mechanism("all bounces", [PathTracingDenoised(bounces=None, spp=n) for n in (1, 4, 16)]),
    ]


def ladder(
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (320, 180),
    seeds: Sequence[int] = range(3),
    rungs: Sequence[Mechanism] | None = None,
    reference: Reference | None = None,
    folder: str | Path | None = None,
) -> Ladder:
    """Climb from direct light and constant ambient upward until the gain is noise: which mechanisms a view needs, and what each costs.

    rungs: the mechanisms (None: `mechanisms()`). Each is measured with few samples and with more, and stands at the fewest beyond which
    more gain nothing. A rung without a gain over the best one below is not needed; the climb ends where the error, or all that exact
    light could still give, lies within the truth's noise. Everything measured is a record in `folder` (None: the user's cache).
    """
    name, wanted = camera_name(scene, camera), reference or Reference()
    folder = study_folder("ladder", scene, name, size) if folder is None else Path(folder)
    climb = _Climb(scene, name, size, tuple(seeds), wanted, folder)
    stopped = "every mechanism was tried"
    for mechanism in rungs if rungs is not None else mechanisms():
        reason = climb.end()
        if reason:
            stopped = reason
            break
        climb.add(mechanism)
    return Ladder(scene, name, size, tuple(climb.rungs), climb.truth.noise, stopped, folder)


class _Climb:
    """The rungs so far, the truth, and what exact light of few bounces leaves."""

    def __init__(self, scene: Scene, camera: str, size: tuple[int, int], seeds: tuple[int, ...], wanted: Reference, folder: Path) -> None:
        self.scene, self.camera, self.size, self.seeds, self.wanted, self.folder = scene, camera, size, seeds, wanted, folder
        self.truth = self._exact(None)
        self.rungs: list[Rung] = []
        self.best: npt.NDArray[np.float64] | None = None  # errors, seed by seed, of the highest needed rung

    def end(self) -> str:
        """Why the climb ends here; empty where it goes on."""
        if self.best is not None and self.best.mean() <= self.truth.noise:
            return "stopped: what error is left lies within the truth's own noise"
        exact = self.rungs[-1].exact_error if self.rungs else np.nan
        if exact <= self.truth.noise:  # False for NaN
            return f"stopped: beyond {self.rungs[-1].mechanism} exact light gains {exact:.1e}, within the truth's own noise"
        return ""

    def add(self, mechanism: Mechanism) -> None:
        study = Study(
            name=f"ladder: {mechanism.name}", scenes=[self.scene], cameras=[self.camera], methods=mechanism.settings, size=self.size,
            seeds=self.seeds, bounces=None, reference=self.wanted, repeats=3, max_repeats=10, images=False,
        )  # fmt: skip
        groups = measured(study, self.folder)
        whole = [(method, group) for method, group in zip(mechanism.settings, groups, strict=True) if all(r.status == OK for r in group)]
        if not whole:
            raise ValueError(f"ladder: {mechanism.name}: no setting could be measured: {groups[0][0].failure}")
        errors = [self._errors(group) for _, group in whole]
        chosen = self._enough(errors)
        self.rungs.append(self._rung(mechanism, *whole[chosen], errors[chosen], whole))

    def _errors(self, group: Sequence[Record]) -> npt.NDArray[np.float64]:
        return np.array([record.metrics["relmse"] for record in group]) - self.truth.noise

    def _enough(self, errors: Sequence[npt.NDArray[np.float64]]) -> int:
        """The fewest samples after which more gain nothing."""
        chosen = 0
        for index in range(1, len(errors)):
            if not self._exceeds(errors[chosen] - errors[index]):
                break
            chosen = index
        return chosen

    def _exceeds(self, gains: npt.NDArray[np.float64]) -> bool:
        low, _ = mean_interval(gains)
        return bool(gains.mean() > self.truth.noise and not low <= 0)  # one seed has no interval

    def _rung(self, mechanism: Mechanism, method: Method, group: Sequence[Record], errors: npt.NDArray[np.float64], whole: Any) -> Rung:
        milliseconds = _times(group)
        below = [rung for rung in self.rungs if rung.needed]
        gains = self.best - errors if self.best is not None else np.full(len(errors), np.nan)
        needed = self.best is None or self._exceeds(gains)
        gain_low, gain_high = mean_interval(gains)
        low, high = mean_interval(errors)
        if needed:
            self.best = errors
        note = "" if needed or gains.mean() < -self.truth.noise else WITHIN_NOISE
        return Rung(
            mechanism.name, method, float(errors.mean()), low, high, float(np.median(milliseconds)), *median_interval(milliseconds),
            gain=float(gains.mean()), gain_low=gain_low, gain_high=gain_high,
            extra_milliseconds=float(np.median(milliseconds)) - (below[-1].milliseconds if below else 0.0),
            exact_error=self._remains(mechanism.bounces),
            needed=needed,
            note=note,
            settings=tuple((words(m), float(self._errors(g).mean()), float(np.median(_times(g)))) for m, g in whole),
            records=tuple(group),
        )  # fmt: skip

    def _remains(self, bounces: int | None) -> float:
        """relMSE of exact light of so many bounces, from independent halves, so that no noise is in it."""
        if bounces is None:
            return np.nan
        some, epsilon = self._exact(bounces), metrics.epsilon(self.truth.image)
        a, b = (np.asarray(half, np.float64) - whole for half, whole in zip(some.halves, self.truth.halves, strict=True))
        below = self.truth.image.astype(np.float64) ** 2 + epsilon
        return float(np.divide(a * b, below, out=np.zeros_like(below), where=below > 0).mean())

    def _exact(self, bounces: int | None) -> Truth:
        return make_truth(self.scene, self.camera, self.size, bounces, self.wanted.noise, self.wanted.max_spp)


def _times(group: Sequence[Record]) -> list[float]:
    """Every repeat's milliseconds, of all seeds."""
    return [milliseconds for record in group for milliseconds in record.every_time]
