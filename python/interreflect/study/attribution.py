"""Which stage costs most? Every approximating stage is replaced by its exact counterpart, one at a time and all but one."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from interreflect import _core
from interreflect.methods.knobs import is_technique
from interreflect.methods.method import Method
from interreflect.study.interface import Image, Scene
from interreflect.study.measured import measured, same, study_folder, words
from interreflect.study.records import OK, Record, Records
from interreflect.study.reference import Reference, camera_name
from interreflect.study.study import Study
from interreflect.study.uncertainty import mean_interval

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

REPLACED = "replaced"
MORE_SAMPLES = "exact, more samples"
EXACT = "already exact"
LEFT_OUT = "left out"
NO_COUNTERPART = "no exact counterpart"
FIXED = "no technique to choose"
FAILED = "counterpart failed"
MEASURED = (REPLACED, MORE_SAMPLES, LEFT_OUT)  # statuses of stages whose share of the error is measured
WITHIN_NOISE, NO_EFFECT = "within noise", "changes nothing here"
AS_IS, ALL_EXACT = "as is", "all exact"


@dataclasses.dataclass(frozen=True)
class StageShare:
    """One stage's part in a method's error and time. Errors are shares of the method's own error; NaN where nothing was replaced.

    error: half of what vanishes when this stage alone becomes exact, and half of what it adds where all others are exact (`alone`,
    `added`); low, high: 95 % interval over seeds. Negative: its error cancels another stage's. time: share of the frame.
    """

    stage: str
    technique: str
    counterpart: str
    status: str
    error: float = np.nan
    low: float = np.nan
    high: float = np.nan
    alone: float = np.nan
    added: float = np.nan
    milliseconds: float = np.nan
    time: float = np.nan
    note: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class Attribution:
    """What `attribute` found. Shares of error sum to 1 with `interaction` and `rest`, those of time with `outside`.

    error: relMSE of the method as it is, the truth's noise subtracted. noise: the part of `error` that changes with the seed.
    interaction: share that no single stage owns. rest: share that stays with every counterpart in place: stages without one, missing
    transport. exact_noise: the counterparts' own sampling noise as a share, which is in none of the others. truth_noise: relMSE of
    the truth itself.
    """

    method: Method
    scene: Scene
    camera: str
    metric: str
    stages: tuple[StageShare, ...]
    error: float
    noise: float
    interaction: float
    rest: float
    exact_noise: float
    truth_noise: float
    milliseconds: float
    outside: float
    records: Records
    variants: Mapping[str, tuple[Record, ...]]  # "as is", "<stage>", "not <stage>", "all exact" -> a record per seed

    @property
    def table(self) -> pd.DataFrame:
        """A row per stage, then the interaction, what remains, and the whole."""
        import pandas as pd

        rows = [dataclasses.asdict(stage) for stage in self.stages]
        rows += [
            {"stage": "(interaction)", "error": self.interaction},
            {"stage": "(no stage's)", "error": self.rest, "note": f"counterparts' own noise {self.exact_noise:.1%}"},
            {"stage": "(outside stages)", "milliseconds": self.outside * self.milliseconds, "time": self.outside},
            {"stage": "(whole)", "error": 1.0, "milliseconds": self.milliseconds, "time": 1.0, "note": self._whole()},
        ]
        return pd.DataFrame(rows).fillna({"technique": "", "counterpart": "", "status": "", "note": ""})

    @property
    def ranking(self) -> tuple[StageShare, ...]:
        """The stages whose share of error was measured and exceeds noise, largest first."""
        return tuple(sorted((s for s in self.stages if s.status in MEASURED and not s.note), key=lambda s: -s.error))

    def chart(self, dark: bool = False) -> Figure:
        """Bars of each stage's share of error, with intervals, and of time."""
        from interreflect.charts.attribution import shares

        return shares(self, dark)

    def images(self, dark: bool = False) -> Figure:
        """A row of pictures: truth, method, and what each stage's approximation changes, on one scale."""
        from interreflect.charts.attribution import differences

        return differences(self, dark)

    def image(self, variant: str) -> Image:
        """The picture of a variant, the mean of its seeds."""
        return np.mean([self.records.images(record)[0] for record in self.variants[variant]], axis=0, dtype=np.float32)  # type: ignore[no-any-return]

    def truth(self) -> Image:
        return self.records.truth(self.variants[AS_IS][0])[0]

    def _whole(self) -> str:
        return f"{self.metric} {self.error:.3g}, of it noise {self.noise:.3g}; truth's own noise {self.truth_noise:.1e}"

    def __repr__(self) -> str:
        return f"{self.method.name} on {self.scene.name}, {self.camera}: {self._whole()}\n{self.table.to_string(index=False)}"

    def _repr_html_(self) -> str:
        return f"<p>{self.method.name} on {self.scene.name}, {self.camera}</p>{self.table.to_html(index=False)}"


def attribute(
    method: Method,
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (320, 180),
    seeds: Sequence[int] = range(4),
    samples: int = 128,
    metric: str = "relmse",
    reference: Reference | None = None,
    folder: str | Path | None = None,
) -> Attribution:
    """Each stage's share of a method's error and time on one view, by exact counterparts one at a time and all but one.

    Counterparts of techniques are their stages' own; a method tells those of its other stages (`own_stages`): more paths, no denoising.
    Counterparts that are random estimates take `samples` samples: rays, texels that are lights, points on all lights together; the
    noise that this leaves is known from the seeds, subtracted and stated (`exact_noise`).
    A stage that is exact already but has fewer samples is measured too: its share is its noise. Seeds are averaged, the truth's noise
    is subtracted, and shares within it, or whose interval holds 0, say "within noise". metric: "relmse" or "indirect_relmse".
    A stage whose counterpart fails among the other techniques is a row that says why and has no share: what it costs is left in the
    interaction. Everything measured is a record in `folder` (None: the user's cache), so that it resumes. ValueError where the method
    itself fails, or all counterparts together.
    """
    if metric not in ("relmse", "indirect_relmse"):
        raise ValueError(f"attribute: metric must be 'relmse' or 'indirect_relmse', got {metric!r}")
    if len(tuple(seeds)) < 2:
        raise ValueError(f"attribute: at least two seeds tell noise from error, got {tuple(seeds)}")
    name = camera_name(scene, camera)
    plan = {stage: counterpart_of(stage, technique, _share(method, stage, samples)) for stage, technique in _fields(method).items()}
    plan |= {stage: own_counterpart(method, stage, samples) for stage in method.own_stages}
    variants = _variants(method, {stage: new for stage, (status, new) in plan.items() if status in MEASURED}, samples)
    folder = study_folder("attribution", scene, name, size, method) if folder is None else Path(folder)
    base: dict[str, Any] = {"scenes": [scene], "cameras": [name], "size": size, "seeds": tuple(seeds)}
    base["reference"] = reference or Reference()
    title = f"attribution of {method.name}"
    exact = {same(variant): variant for variant in variants.values() if same(variant) != same(method)}
    (own,) = measured(Study(name=title, methods=[method], repeats=5, max_repeats=15, **base), folder)
    groups = {same(method): own}
    if exact:
        others = measured(Study(name=f"{title}, exact", methods=list(exact.values()), repeats=0, **base), folder)
        groups |= zip(exact, others, strict=True)
    return _judge(method, scene, name, metric, plan, {key: groups[same(variant)] for key, variant in variants.items()}, folder)


def counterpart_of(stage: str, technique: Any, samples: int) -> tuple[str, Any]:
    """How exact a stage is already, and what would be: its status and the technique to put in its place (None: nothing)."""
    exact = _core.stages.get(stage, {}).get("exact")
    if exact is None:
        return NO_COUNTERPART, None
    if technique is None:
        return LEFT_OUT, _with_samples(exact(), samples)
    if not isinstance(technique, exact):
        return REPLACED, _with_samples(exact(**_kept(technique, exact)), samples)
    more = _with_samples(technique, samples)
    return (MORE_SAMPLES, more) if getattr(more, "samples", 0) > getattr(technique, "samples", 0) else (EXACT, None)


def _kept(technique: Any, exact: Any) -> dict[str, Any]:
    """Knobs of both that say what the stage makes, not how well: the later stages' share is what comes of them."""
    names = {param["name"] for param in exact.description["params"]}
    return {name: getattr(technique, name) for name in ("bands", "resolution", "both_sides") if name in names and hasattr(technique, name)}


def _share(method: Method, stage: str, samples: int) -> int:
    """Samples of a stage's own: what looks at every virtual light spreads them over the lights."""
    lights = method.knobs().get("sample_lights.lights", 1) if stage == "filter_shadows" else 1
    return max(1, samples // int(lights))


def own_counterpart(method: Method, stage: str, samples: int) -> tuple[str, Method | None]:
    """The same for a stage that the method makes itself; what would be exact is another method."""
    exact = method.exactly([stage], samples)
    if same(exact) == same(method):
        return EXACT, None
    return (MORE_SAMPLES if type(exact) is type(method) else REPLACED), exact


def _with_samples(technique: Any, samples: int) -> Any:
    """With as many samples an estimate; one that fills the texels of a map spreads them over the map."""
    if not isinstance(getattr(technique, "samples", None), int):
        return technique
    texels = getattr(technique, "resolution", 1) ** 2
    return technique.replace(samples=-(-samples // texels))


def _fields(method: Method) -> dict[str, Any]:
    """Field -> technique, and None for stages that are left out."""
    held = {name: value for name, value in method.exact_knobs().items() if is_technique(value)}
    absent = {name: None for name, value in method.knobs().items() if value is None and name in _core.stages}
    return held | absent


def _variants(method: Method, changes: Mapping[str, Any], samples: int) -> dict[str, Method]:
    """As it is, with one stage exact, with all but one exact, with all exact."""

    def exact(stages: Sequence[str]) -> Method:
        own = [stage for stage in stages if stage in method.own_stages]
        return method.replace({stage: changes[stage] for stage in stages if stage not in own}).exactly(own, samples)

    variants = {AS_IS: method, ALL_EXACT: exact(list(changes))}
    for stage in changes:
        variants[stage] = exact([stage])
        variants[f"not {stage}"] = exact([other for other in changes if other != stage])
    return variants


def _failure(group: tuple[Record, ...]) -> str:
    """Of a variant; empty where none of its records failed."""
    failed = (f"{record.configuration}: {record.status}: {record.failure}" for record in group if record.status != OK)
    return next(failed, "")


def _refused(plan: Mapping[str, Any], groups: Mapping[str, tuple[Record, ...]]) -> dict[str, str]:
    """Stages whose counterpart fails, and why. ValueError where there is nothing to compare with."""
    for variant in (AS_IS, ALL_EXACT):
        if failure := _failure(groups[variant]):
            raise ValueError(f"attribute: {failure}")
    tried = (stage for stage, (status, _) in plan.items() if status in MEASURED)
    failures = {stage: _failure(groups[stage]) or _failure(groups[f"not {stage}"]) for stage in tried}
    return {stage: failure for stage, failure in failures.items() if failure}


def _judge(
    method: Method, scene: Scene, camera: str, metric: str, plan: Mapping[str, Any], groups: Mapping[str, tuple[Record, ...]], folder: Path
) -> Attribution:
    records = Records(f"attribution of {method.name}", tuple(record for group in groups.values() for record in group), folder)
    refused = _refused(plan, groups)
    groups = {key: group for key, group in groups.items() if key.removeprefix("not ") not in refused}
    truth_noise = groups[AS_IS][0].noise if metric == "relmse" else groups[AS_IS][0].indirect_noise
    errors = {key: np.array([record.metrics[metric] for record in group]) - truth_noise for key, group in groups.items()}
    error = float(errors[AS_IS].mean())
    share_of = 1 / error if error > 0 else np.nan  # an error within the truth's noise has no shares
    spent = _stage_times(groups[AS_IS])
    frame = float(np.median([record.milliseconds for record in groups[AS_IS]]))
    noises = {key: _seed_noise(records, group, metric) for key, group in groups.items()}
    stages = []
    for stage in _in_order(spent, plan):
        status, counterpart = plan.get(stage, (FIXED, None))
        milliseconds = spent.get(stage, np.nan)
        share = StageShare(stage, _words(method, stage), _named(counterpart), status)
        share = dataclasses.replace(share, milliseconds=milliseconds, time=milliseconds / frame)
        if stage in refused:
            share = dataclasses.replace(share, status=FAILED, note=refused[stage])
        elif status in MEASURED:
            # Noise between seeds is the counterparts' own, and no stage's error, but for what vanishes with this stage alone.
            own = max(0.0, noises[AS_IS] - noises[stage]) / (1 - _noise_kept(method, stage, counterpart))
            alone = (errors[AS_IS] - noises[AS_IS]) - (errors[stage] - noises[stage]) + own
            added = (errors[f"not {stage}"] - noises[f"not {stage}"]) - (errors[ALL_EXACT] - noises[ALL_EXACT]) + own
            share = dataclasses.replace(share, **_shares(alone, added, share_of, truth_noise))
        stages.append(share)
    owned = sum(stage.error for stage in stages if stage.status in MEASURED)
    replaceable = any(status in MEASURED for status, _ in plan.values())
    rest = (float(errors[ALL_EXACT].mean()) - noises[ALL_EXACT]) * share_of if replaceable else 1.0
    return Attribution(
        method, scene, camera, metric, tuple(stages), error,
        noise=noises[AS_IS],
        interaction=1 - rest - owned,
        rest=rest,
        exact_noise=noises[ALL_EXACT] * share_of,
        truth_noise=truth_noise,
        milliseconds=frame,
        outside=max(0.0, 1 - sum(spent.values()) / frame),
        records=records,
        variants=groups,
    )  # fmt: skip


def _shares(alone: npt.NDArray[np.float64], added: npt.NDArray[np.float64], share_of: float, truth_noise: float) -> dict[str, Any]:
    both = (alone + added) / 2
    low, high = mean_interval(both)
    gain = float(both.mean())
    unresolved = abs(gain) <= truth_noise or not (low > 0 or high < 0)
    silent = not (alone.any() or added.any())
    return {
        "error": gain * share_of,
        "low": low * share_of,
        "high": high * share_of,
        "alone": float(alone.mean()) * share_of,
        "added": float(added.mean()) * share_of,
        "note": NO_EFFECT if silent else WITHIN_NOISE if unresolved else "",
    }


def _in_order(spent: Mapping[str, float], plan: Mapping[str, Any]) -> list[str]:
    """The profile's stages as they ran, and the method's other fields, each before the one that the method names next."""
    order, fields = list(spent), list(plan)
    for place, stage in reversed(list(enumerate(fields))):
        if stage not in order:
            after = [order.index(other) for other in fields[place + 1 :] if other in order]
            order.insert(after[0] if after else len(order), stage)
    return order


def _stage_times(records: Sequence[Record]) -> dict[str, float]:
    names = dict.fromkeys(name for record in records for name in record.stages)
    return {name: float(np.median([record.stages[name]["milliseconds"] for record in records if name in record.stages])) for name in names}


def _words(method: Method, stage: str) -> str:
    if stage in method.own_stages:
        return type(method).__name__
    return repr(_fields(method)[stage]) if stage in _fields(method) else ""


def _named(counterpart: Any) -> str:
    return words(counterpart) if isinstance(counterpart, Method) else repr(counterpart) if counterpart else ""


def _noise_kept(method: Method, stage: str, counterpart: Any) -> float:
    """The share of a random stage's noise that its counterpart still has: its variance falls with the number of samples."""
    before = method if stage in method.own_stages else _fields(method)[stage]
    if type(before) is not type(counterpart) or getattr(before, "milliseconds", None) is not None:
        return 0.0
    few, many = (getattr(side, "samples", None) or getattr(side, "spp", None) for side in (before, counterpart))
    return few / many if few and many else 0.0


def _seed_noise(records: Records, group: Sequence[Record], metric: str) -> float:
    """The part of the error that changes with the seed: the variance between seeds, relative as relMSE is."""
    from interreflect.metrics import epsilon

    which = 0 if metric == "relmse" else 1
    truth = records.truth(group[0])[which].astype(np.float64)
    spread = np.var([records.images(record)[which] for record in group], axis=0, ddof=1, dtype=np.float64)
    below = truth**2 + epsilon(truth)
    return float(np.mean(np.divide(spread, below, out=np.zeros_like(spread), where=below > 0)))
