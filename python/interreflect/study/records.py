"""Records: the measured cells of a study, and their table."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

    from interreflect.study.calibration import Calibration
    from interreflect.study.interface import Image

OK, FAILED, NOT_FINITE = "ok", "failed", "not finite"
ALL_BOUNCES = "all"
METRICS = (
    "relmse", "trimmed_relmse", "energy_ratio", "flip", "ssim", "hue_shift",
    "indirect_relmse", "indirect_trimmed_relmse", "indirect_energy_ratio",
)  # fmt: skip
FIXED = (
    "scene", "camera", "bounces", "method", "seed", "status", "failure",
    "milliseconds", "milliseconds_low", "milliseconds_high", "milliseconds_p95", "contended", "others_share",
    "precompute_milliseconds", "peak_memory_bytes", "calibration", "limit_milliseconds", "limit_ratio", *METRICS, "noise", "indirect_noise",
    "width", "height", "threads", "repeats", "truth_spp", "scene_hash", "processor", "compiler", "commit", "warnings", "key",
)  # fmt: skip
MAY_BE_NAN = ("metrics", "knobs", "limits")  # and every number of a record itself; stages only where nothing was timed


@dataclasses.dataclass(frozen=True, eq=False)
class Record:
    """One measured cell. Numbers that were not measured are NaN; `status` says why, `failure` in which words."""

    key: str
    scene: str
    scene_hash: str
    camera: str
    camera_values: Mapping[str, Any]
    method: str
    knobs: Mapping[str, Any]
    seed: int
    size: tuple[int, int]
    bounces: int | None
    threads: int
    machine: Mapping[str, Any]
    status: str = OK
    failure: str = ""
    repeats: int = 0
    milliseconds: float = math.nan
    milliseconds_low: float = math.nan  # 95 % interval of the median
    milliseconds_high: float = math.nan
    milliseconds_p95: float = math.nan
    times: tuple[float, ...] = ()  # milliseconds of every repeat, in order
    contended: bool = False  # others used the processors meanwhile, also when it was timed again
    others_share: float = math.nan  # of the processors
    precompute_milliseconds: float = math.nan
    calibration: str = ""  # key of what the machine was measured to do, in the study's folder
    peak_memory_bytes: float = math.nan  # of the worker while it prepared and rendered, above an idle one's
    limits: Mapping[str, float] = dataclasses.field(default_factory=dict)  # timeout or memory, where the cell passed it
    metrics: Mapping[str, float] = dataclasses.field(default_factory=dict)
    stages: Mapping[str, Mapping[str, Any]] = dataclasses.field(default_factory=dict)
    noise: float = math.nan
    indirect_noise: float = math.nan
    truth: str = ""
    truth_spp: int = 0
    warnings: tuple[str, ...] = ()
    images: bool = False

    def as_content(self) -> dict[str, Any]:
        """What is written to the record's file: JSON without numbers that JSON lacks."""
        return {field.name: _portable(getattr(self, field.name)) for field in dataclasses.fields(self)}

    @staticmethod
    def from_content(content: Mapping[str, Any]) -> Record:
        """The inverse of `as_content`."""
        values: dict[str, Any] = {name: _restored_here(value) if name in MAY_BE_NAN else _number(value) for name, value in content.items()}
        values |= {name: tuple(values[name]) for name in ("size", "warnings", "times")}
        if values["repeats"] == 0:
            values["stages"] = {name: _restored_here(stage) for name, stage in values["stages"].items()}
        return Record(**values)

    @property
    def configuration(self) -> str:
        """The method and its knobs in one line."""
        return f"{self.method}({', '.join(f'{name}={value}' for name, value in self.knobs.items())})"

    @property
    def every_time(self) -> tuple[float, ...]:
        """Every repeat's milliseconds; their median alone in a record that was made without them."""
        return self.times or (self.milliseconds,)

    def row(self, calibration: Calibration | None = None) -> dict[str, Any]:
        """The record as a row of the table. calibration: of its machine."""
        fixed = {name: getattr(self, name) for name in FIXED if hasattr(self, name)}
        fixed |= {"width": self.size[0], "height": self.size[1], "bounces": ALL_BOUNCES if self.bounces is None else self.bounces}
        fixed |= {name: self.machine.get(name, "") for name in ("processor", "compiler", "commit")}
        fixed |= {name: self.metrics.get(name, math.nan) for name in METRICS}
        fixed["warnings"] = "; ".join(self.warnings)
        limit = math.nan if calibration is None else calibration.limit_milliseconds(self.stages)
        fixed |= {"limit_milliseconds": limit, "limit_ratio": self.milliseconds / limit}
        knobs = {knob_column(name): value for name, value in self.knobs.items()}
        measured: dict[str, Any] = {}
        for name, stage in self.stages.items():
            measured[f"stage.{name}.milliseconds"] = stage["milliseconds"]
            measured[f"stage.{name}.bytes"] = stage["bytes"]
            measured |= {f"stage.{name}.{key}": count for key, count in stage["counts"].items()}
        return {name: fixed[name] for name in FIXED} | knobs | measured


def knob_column(knob: str) -> str:
    """A knob's column: its path; with "method." before it where a measured column has that name."""
    return f"method.{knob}" if knob in FIXED or knob.startswith("stage.") else knob


@dataclasses.dataclass(frozen=True, eq=False)
class Records(Sequence[Record]):
    """The records of a study in the order of its cells. `missing` cells are not measured yet; `damaged` files were left out."""

    study: str
    records: tuple[Record, ...]
    folder: Path
    missing: int = 0
    damaged: tuple[str, ...] = ()
    calibrations: Mapping[str, Calibration] = dataclasses.field(default_factory=dict)  # what the machines can do

    @cached_property
    def table(self) -> pd.DataFrame:
        """A row per cell (scene x camera x method x seed); columns: what was measured, knob paths, `stage.<name>.<what>`.

        limit_milliseconds: what the record's machine needs at full speed for the work that was counted; limit_ratio: `milliseconds`
        as a multiple of it, which compares between machines. NaN where no work was counted or the calibration is not there.
        """
        import pandas as pd

        rows = [record.row(self.calibrations.get(record.calibration)) for record in self.records]
        columns = dict.fromkeys([*FIXED, *(name for row in rows for name in row)])
        return pd.DataFrame(rows, columns=list(columns))

    @cached_property
    def knob_columns(self) -> list[str]:
        """The table's columns that are knobs."""
        return [knob_column(name) for name in dict.fromkeys(name for record in self.records for name in record.knobs)]

    def has_images(self, record: Record) -> bool:
        """Are the pictures of this record and of its truth there?"""
        return record.images and all(path.exists() for path in self._pictures(record))

    def images(self, record: Record) -> tuple[Image, Image]:
        """The image and the indirect light of a record. FileNotFoundError where the study kept none."""
        return _load_pair(self._pictures(record)[0])

    def truth(self, record: Record) -> tuple[Image, Image]:
        """The image and the indirect light of the truth that a record was compared with."""
        return _load_pair(self._pictures(record)[1])

    def _pictures(self, record: Record) -> tuple[Path, Path]:
        return self.folder / "images" / f"{record.key}.npz", self.folder / "truths" / f"{record.truth}.npz"

    def __getitem__(self, index: Any) -> Any:
        return self.records[index]

    def __len__(self) -> int:
        return len(self.records)

    def __iter__(self) -> Iterator[Record]:
        return iter(self.records)

    def __repr__(self) -> str:
        failed = sum(record.status != OK for record in self.records)
        return f"<Records {self.study!r}: {len(self.records)} cells, {failed} failed, {self.missing} missing>"

    def _repr_html_(self) -> str:
        return str(self.table.to_html(max_rows=60, float_format=lambda number: f"{number:.4g}"))


def _load_pair(path: Path) -> tuple[Image, Image]:
    with np.load(path, allow_pickle=False) as kept:
        return kept["image"], kept["indirect"]


def _portable(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return {"number": repr(value)}
    if isinstance(value, Mapping):
        return {str(key): _portable(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_portable(item) for item in value]
    if isinstance(value, np.generic):
        return _portable(value.item())
    return value if value is None or isinstance(value, bool | int | float | str) else str(value)


def _restored_here(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _number(value) for name, value in values.items()}


def _number(value: Any) -> Any:
    """The inverse of `_portable` for a number that JSON lacks; anything else as it is."""
    return float(value["number"]) if type(value) is dict and value.keys() == {"number"} else value
