"""Configurations: records with their seeds averaged, the truth's noise subtracted, and intervals on both axes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from interreflect.study.records import METRICS, OK, Records
from interreflect.study.uncertainty import Interval, mean_intervals, median_interval

if TYPE_CHECKING:
    import pandas as pd

VIEW = ["scene", "camera", "bounces"]
COSTS = ("milliseconds", "milliseconds_p95", "precompute_milliseconds", "bytes", "peak_memory_bytes")
WORK = "work."  # columns of work counts: rays, steps, fetches, ...
NOISE_OF = {  # an error that the truth's noise bounds -> the column that holds that noise
    "relmse": "noise",
    "trimmed_relmse": "noise",
    "indirect_relmse": "indirect_noise",
    "indirect_trimmed_relmse": "indirect_noise",
}
NOISE_ADDS = ("relmse", "indirect_relmse")  # expected to be larger by exactly that noise; what trimming leaves of it is not known
ERRORS = (*NOISE_OF, "flip")
MERIT = "ssim"  # better where larger
WITH_INTERVALS = (*ERRORS, MERIT)
PER_SEED = ("seed", "status", "failure", "key")  # columns of cells that configurations do not have


def configurations(records: Records) -> pd.DataFrame:
    """A row per view and configuration: measured columns averaged over its seeds (the median of times), `seeds` their number.

    relmse and indirect_relmse: the truth's noise (`noise`, `indirect_noise`) is subtracted, so that they may fall below 0 where it is all
    there is. `<error>_low`, `_high`: 95 % interval over seeds; `milliseconds_low`, `_high`: of the median over all seeds' repeats. bytes:
    what the stages' results hold. peak_memory_bytes: of the process. `work.<count>`: work of all stages. Cells that failed or are not
    finite are left out, and so are configurations of which any seed did.
    """
    import pandas as pd

    by = [*VIEW, "configuration"]
    table = records.table.assign(configuration=[record.configuration for record in records])
    table["record"] = np.array([*records, None], object)[:-1]  # None keeps numpy from looking into records
    failed = table.assign(failed=table["status"] != OK).groupby(by, sort=False)["failed"].transform("any")
    kept = _with_sums(table[~failed.astype(bool)].drop(columns=list(PER_SEED)))
    for error in NOISE_ADDS:
        kept[error] = kept[error].astype(float) - kept[NOISE_OF[error]].astype(float)
    measured = [name for name in kept.columns if name not in records.knob_columns and _is_measured(name)]
    how = dict.fromkeys(kept.columns.difference([*by, "record"], sort=False), "first")
    how |= {name: "median" if "milliseconds" in name else "mean" for name in measured}
    grouped = kept.astype(dict.fromkeys(measured, float)).groupby(by, sort=False)
    found = grouped.agg(how)
    added: dict[str, Any] = {"seeds": grouped.size()}
    for name, intervals in zip(WITH_INTERVALS, _mean_intervals(kept[list(WITH_INTERVALS)], grouped.ngroup()), strict=True):
        added |= _interval(name, intervals)
    times: list[list[float]] = [[] for _ in range(len(found))]
    for index, record in zip(grouped.ngroup(), kept["record"], strict=True):
        times[index] += record.every_time
    added |= _interval("milliseconds", [median_interval(group) for group in times])
    found = found.drop(columns=list(added), errors="ignore")  # a record's own interval gives way to that of all its seeds
    joined = pd.concat([found, pd.DataFrame(added, index=found.index)], axis=1)
    return joined.copy().reset_index()  # the copy is one piece: to many, columns are added slowly and with a warning


def _with_sums(table: pd.DataFrame) -> pd.DataFrame:
    """Bytes and work counts of all stages together."""
    import pandas as pd

    stages = [column.split(".", 2) for column in table.columns if column.startswith("stage.")]
    sums: dict[str, list[str]] = {}
    for parts in stages:
        if len(parts) == 3 and parts[2] != "milliseconds":
            sums.setdefault("bytes" if parts[2] == "bytes" else WORK + parts[2], []).append(".".join(parts))
    added: dict[str, Any] = {"bytes": np.nan}
    added |= {name: table[columns].astype(float).sum(axis=1) for name, columns in sums.items()}
    return pd.concat([table, pd.DataFrame(added, index=table.index)], axis=1)


def _mean_intervals(values: pd.DataFrame, group: pd.Series[int]) -> npt.NDArray[np.float64]:
    """Of each column's mean over each group, (columns, groups, 2); groups of one size together."""
    order = np.argsort(group.to_numpy(), kind="stable")
    columns, sizes = values.to_numpy(float)[order].T, np.bincount(group)
    starts = np.cumsum(sizes) - sizes
    intervals = np.empty((len(columns), len(sizes), 2))
    for size in np.unique(sizes):
        alike = np.flatnonzero(sizes == size)
        rows = columns[:, starts[alike][:, None] + np.arange(size)]
        intervals[:, alike] = mean_intervals(rows.reshape(-1, size)).reshape(len(columns), len(alike), 2)
    return intervals


def _interval(name: str, intervals: Sequence[Interval] | npt.NDArray[np.float64]) -> dict[str, list[float]]:
    return {f"{name}_low": [low for low, _ in intervals], f"{name}_high": [high for _, high in intervals]}


def _is_measured(column: str) -> bool:
    known = (*COSTS, *METRICS, "noise", "indirect_noise")
    return column.startswith(("stage.", WORK)) or column in known
