"""Which knobs matter? Elementary effects of every knob first, then variance shares of those that have any, on error and on time."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from interreflect.study.interface import Method, Scene
from interreflect.study.measured import measured, same, study_folder
from interreflect.study.records import OK, Record
from interreflect.study.reference import Reference, camera_name
from interreflect.study.space import Axis, axes_of
from interreflect.study.study import Study

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    Numbers = npt.NDArray[np.float64]

LEVELS = 4  # of Morris's grid
LEAST_EFFECT = 0.02  # decades over a knob's whole range: 5 %, what no picture or frame rate shows
NOISE_SETTINGS = 16  # measured once more, prepared anew, to tell what changes without any knob
MOST_SHARED = 6  # knobs that variance is shared among: each costs as many renders as the base sample


@dataclasses.dataclass(frozen=True, eq=False)
class Sensitivity:
    """What `sensitivity` found. Effects and noises are in decades (1: a factor of ten) over a knob's whole range.

    indices: a row per knob with its range, `<error|time>_effect` (Morris's mu*), `_conf` (its 95 % half interval), `_spread` (sigma: by how
    much the effect depends on the other knobs), `_first` and `_total` (Sobol, with `_total_low`, `_high`; NaN for knobs not among those
    shared), and `matters`: on what. idle: knobs that matter for neither, i.e. no effect above noise and 5 %. failed: settings left out.
    """

    method: Method
    scene: Scene
    camera: str
    indices: pd.DataFrame
    noise: Mapping[str, float]
    failed: int
    folder: Path

    @property
    def idle(self) -> list[str]:
        return [str(knob) for knob in self.indices.loc[self.indices["matters"] == "", "knob"]]

    def chart(self, dark: bool = False) -> Figure:
        """Effects of every knob on error and time, with their intervals, beside the noise."""
        from interreflect.charts.sensitivity import effects

        return effects(self, dark)

    def __repr__(self) -> str:
        idle = ", ".join(self.idle) or "none"
        head = f"{self.method.name} on {self.scene.name}, {self.camera}; knobs that do not matter: {idle}"
        return f"{head}\n{self.indices.to_string(index=False, float_format=lambda number: f'{number:.3g}')}"

    def _repr_html_(self) -> str:
        return f"<p>{self.method.name} on {self.scene.name}: do not matter: {', '.join(self.idle) or 'none'}</p>{self.indices.to_html()}"


def sensitivity(
    method: Method,
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (80, 60),
    ranges: Mapping[str, Any] | None = None,
    knobs: Sequence[str] | None = None,
    trajectories: int = 6,
    samples: int = 32,
    reference: Reference | None = None,
    folder: str | Path | None = None,
    seed: int = 0,
) -> Sensitivity:
    """Morris's elementary effects [Morris 1991; Campolongo et al. 2007] of each knob on the logarithms of error and time, then Sobol's
    indices [Saltelli et al. 2010] of the most influential ones.

    knobs, ranges: see `axes_of`. trajectories: of Morris, each measures knobs + 1 settings. samples: base sample of Sobol (a power of two;
    0: none), which measures (knobs + 2) times as many. A knob that moves neither error nor time beyond their noise and 5 % is named in
    `idle`. Everything measured is a record in `folder` (None: the user's cache). ImportError without the extra `search`.
    """
    axes, name = axes_of(method, ranges, knobs), camera_name(scene, camera)
    if not axes:
        raise ValueError(f"sensitivity: {type(method).__name__} has no plain knob to vary")
    folder = study_folder("sensitivity", scene, name, size, method.name) if folder is None else Path(folder)
    bench = _Bench(method, scene, name, size, reference or Reference(noise=3e-3), folder)
    indices, noise = _morris(bench, axes, trajectories, seed)
    if samples:
        strong = indices.assign(most=indices[["error_effect", "time_effect"]].max(axis=1)).sort_values("most", ascending=False)
        shared = [str(knob) for knob in strong.loc[strong["matters"] != "", "knob"].head(MOST_SHARED)]
        indices = indices.merge(_sobol(bench, [axis for axis in axes if axis.path in shared], samples, seed), on="knob", how="left")
    return Sensitivity(method, scene, name, indices, noise, bench.failed, folder)


class _Bench:
    """Measures settings of the method: the logarithms of error and time."""

    def __init__(self, method: Any, scene: Scene, camera: str, size: tuple[int, int], reference: Reference, folder: Path) -> None:
        self.method, self.folder, self.failed = method, folder, 0
        self.base: dict[str, Any] = {"scenes": [scene], "cameras": [camera], "size": size, "reference": reference, "images": False}

    def noise(self, axes: Sequence[Axis], places: Numbers, values: Numbers) -> dict[str, float]:
        """Standard deviations of measurements of one setting, from settings measured before that are prepared and measured again."""
        again = values[:NOISE_SETTINGS] - self.measure(axes, places[:NOISE_SETTINGS], seed=1)
        spread = np.sqrt(np.nanmean(again**2, axis=0) / 2)
        return {"error": float(spread[0]), "time": float(spread[1])}

    def measure(self, axes: Sequence[Axis], places: Numbers, seed: int = 0) -> Numbers:
        """(settings, 2): of each row of places in [0, 1]; NaN for what failed."""
        methods = [self.method.replace({axis.path: axis.at(place) for axis, place in zip(axes, row, strict=True)}) for row in places]
        different = {same(made): made for made in methods}
        study = Study(name="sensitivity", methods=list(different.values()), seeds=[seed], repeats=2, max_repeats=2, **self.base)
        found = {key: self._logarithms(group[0]) for key, group in zip(different, measured(study, self.folder), strict=True)}
        return np.array([found[same(made)] for made in methods])

    def _logarithms(self, record: Record) -> tuple[float, float]:
        if record.status != OK:
            self.failed += 1
            return np.nan, np.nan
        error = max(record.metrics["relmse"] - record.noise, record.noise / 2, 1e-12)
        return float(np.log10(error)), float(np.log10(record.milliseconds))


def _morris(bench: _Bench, axes: Sequence[Axis], trajectories: int, seed: int) -> tuple[pd.DataFrame, dict[str, float]]:
    """Morris's effects, and the noise that they stand out of where they matter."""
    import pandas as pd

    try:
        from SALib.analyze import morris as analysis
        from SALib.sample import morris as sampling
    except ImportError as missing:
        raise ImportError("sensitivity needs SALib: pip install 'interreflect[search]'") from missing
    problem = {"num_vars": len(axes), "names": [axis.path for axis in axes], "bounds": [[0.0, 1.0]] * len(axes)}
    places = np.asarray(sampling.sample(problem, trajectories, num_levels=LEVELS, seed=seed))
    values = bench.measure(axes, places)
    # A trajectory with a setting that failed has no effects along it.
    whole = np.isfinite(values).all(axis=1).reshape(trajectories, -1).all(axis=1).repeat(len(axes) + 1)
    if not whole.any():
        raise ValueError("sensitivity: on every trajectory a setting failed")
    rows = pd.DataFrame({"knob": [axis.path for axis in axes], "value": [axis.value for axis in axes]})
    rows["range"] = [str(axis.choices) if axis.choices else f"{axis.low:g} to {axis.high:g}" for axis in axes]
    for column, quantity in enumerate(("error", "time")):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # a knob without any effect has no spread to divide by
            found = analysis.analyze(problem, places[whole], values[whole, column], num_levels=LEVELS, seed=seed)
        rows[f"{quantity}_effect"], rows[f"{quantity}_conf"] = found["mu_star"], found["mu_star_conf"]
        rows[f"{quantity}_spread"] = found["sigma"]
    noise = bench.noise(axes, places[whole], values[whole])
    step = LEVELS / (2 * (LEVELS - 1))  # of a trajectory, in ranges
    least = {q: max(LEAST_EFFECT, 2 * np.sqrt(2 / np.pi) * np.sqrt(2) * noise[q] / step) for q in ("error", "time")}  # twice that of noise
    rows["matters"] = [", ".join(q for q in least if row[f"{q}_effect"] > least[q]) for _, row in rows.iterrows()]
    return rows, noise


def _sobol(bench: _Bench, axes: Sequence[Axis], samples: int, seed: int) -> pd.DataFrame:
    import pandas as pd
    from scipy.stats import sobol_indices, uniform

    columns = [f"{q}_{what}" for q in ("error", "time") for what in ("first", "total", "total_low", "total_high")]
    if len(axes) < 2:
        return pd.DataFrame(columns=["knob", *columns])

    def values(places: Numbers) -> Numbers:
        logarithms = bench.measure(axes, places.T)
        middle = np.nanmedian(logarithms, axis=0)
        return np.where(np.isfinite(logarithms), logarithms, middle).T  # what failed tells nothing of the variance

    found = sobol_indices(func=values, n=samples, dists=[uniform()] * len(axes), rng=np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # an index that is the same in every resample has no interval
        bounds = found.bootstrap(confidence_level=0.95, n_resamples=200).total_order.confidence_interval
    rows = pd.DataFrame({"knob": [axis.path for axis in axes]})
    for index, quantity in enumerate(("error", "time")):
        rows[f"{quantity}_first"], rows[f"{quantity}_total"] = found.first_order[index], found.total_order[index]
        rows[f"{quantity}_total_low"], rows[f"{quantity}_total_high"] = bounds.low[index], bounds.high[index]
    return rows
