"""What is the next step worth? Each knob of a configuration moved a little: error gained per millisecond and per megabyte."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.study.interface import Method, Scene
from interreflect.study.measured import measured, same, study_folder
from interreflect.study.records import OK, Record
from interreflect.study.reference import Reference, camera_name
from interreflect.study.space import axes_of
from interreflect.study.study import Study
from interreflect.study.uncertainty import mean_interval

if TYPE_CHECKING:
    import pandas as pd

WITHIN_NOISE = "within noise"
MEBIBYTE = 2**20


@dataclasses.dataclass(frozen=True, eq=False)
class Marginals:
    """What `marginal` found. error, milliseconds, megabytes: of the configuration as it is (relMSE less the truth's noise, median, MiB).

    table: a row per step of a knob. change of `error` (with `low`, `high`, 95 % over seeds), `milliseconds` and `megabytes`;
    `error_per_millisecond`, `error_per_megabyte`: error lost per millisecond or MiB that the step adds (or error that comes per
    millisecond or MiB that it saves; NaN where the step costs nothing to speak of); `note`: "within noise", or why it failed.
    """

    method: Method
    scene: Scene
    camera: str
    error: float
    milliseconds: float
    megabytes: float
    truth_noise: float
    table: pd.DataFrame
    folder: Path

    def __repr__(self) -> str:
        head = f"{self.method.name} on {self.scene.name}, {self.camera}: relMSE {self.error:.3g} in {self.milliseconds:.1f} ms"
        return f"{head}\n{self.table.to_string(index=False, float_format=lambda number: f'{number:.3g}')}"

    def _repr_html_(self) -> str:
        return f"<p>relMSE {self.error:.3g} in {self.milliseconds:.1f} ms</p>{self.table.to_html(index=False)}"


def marginal(
    method: Method,
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (160, 90),
    ranges: Mapping[str, Any] | None = None,
    knobs: Sequence[str] | None = None,
    factor: float = 1.5,
    seeds: Sequence[int] = range(3),
    reference: Reference | None = None,
    folder: str | Path | None = None,
) -> Marginals:
    """Error per millisecond and per megabyte of each knob around a configuration, by steps up and down by `factor`.

    Flags are turned and words exchanged for every other. knobs, ranges: see `axes_of`. Everything measured is a record in `folder`
    (None: the user's cache). ValueError where the configuration itself fails.
    """
    import pandas as pd

    name = camera_name(scene, camera)
    folder = study_folder("marginal", scene, name, size, method.name) if folder is None else Path(folder)
    steps = [(axis, value) for axis in axes_of(method, ranges, knobs) for value in axis.neighbours(factor)]
    made = [method.replace({axis.path: value}) for axis, value in steps]
    different = {same(one): one for one in (method, *made)}
    study = Study(
        name=f"marginals of {method.name}", scenes=[scene], cameras=[name], methods=list(different.values()), size=size, seeds=seeds,
        reference=reference or Reference(), repeats=3, max_repeats=10, images=False,
    )  # fmt: skip
    groups = dict(zip(different, measured(study, folder), strict=True))
    own = groups[same(method)]
    if any(record.status != OK for record in own):
        raise ValueError(f"marginal: {own[0].configuration}: {own[0].failure}")
    rows = [
        {"knob": axis.path, "from": axis.value, "to": value} | _change(own, groups[same(one)])
        for (axis, value), one in zip(steps, made, strict=True)
    ]
    noise = own[0].noise
    table = pd.DataFrame(rows)
    return Marginals(method, scene, name, float(_errors(own).mean()) - noise, _milliseconds(own), _megabytes(own), noise, table, folder)


def _change(own: Sequence[Record], other: Sequence[Record]) -> dict[str, Any]:
    failed = [record.failure for record in other if record.status != OK]
    if failed:
        return {"note": failed[0]}
    differences = _errors(other) - _errors(own)
    low, high = mean_interval(differences)
    error, time, memory = float(differences.mean()), _milliseconds(other) - _milliseconds(own), _megabytes(other) - _megabytes(own)
    unresolved = abs(error) <= own[0].noise or low <= 0 <= high
    free = {"milliseconds": abs(time) < 0.02 * _milliseconds(own), "megabytes": abs(memory) < 0.01}
    return {
        "error": error,
        "low": low,
        "high": high,
        "milliseconds": time,
        "megabytes": memory,
        "error_per_millisecond": np.nan if free["milliseconds"] else -error / time,
        "error_per_megabyte": np.nan if free["megabytes"] else -error / memory,
        "note": WITHIN_NOISE if unresolved else "",
    }


def _errors(group: Sequence[Record]) -> Any:
    return np.array([record.metrics["relmse"] for record in group])


def _milliseconds(group: Sequence[Record]) -> float:
    return float(np.median([record.milliseconds for record in group]))


def _megabytes(group: Sequence[Record]) -> float:
    return float(np.mean([sum(stage["bytes"] for stage in record.stages.values()) for record in group])) / MEBIBYTE
