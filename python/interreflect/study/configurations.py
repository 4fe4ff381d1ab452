"""Configurations: records with their seeds averaged, the truth's noise subtracted, and intervals on both axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.study.records import METRICS, OK, Records
from interreflect.study.uncertainty import mean_interval, median_interval

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
    for name in WITH_INTERVALS:
        added |= _interval(name, [mean_interval(group.to_numpy(float)) for _, group in grouped[name]])
    times = [median_interval(np.concatenate([record.every_time for record in group])) for _, group in grouped["record"]]
    added |= _interval("milliseconds", times)
    found = found.drop(columns=list(added), errors="ignore")  # a record's own interval gives way to that of all its seeds
    return pd.concat([found, pd.DataFrame(added, index=found.index)], axis=1).reset_index()


def _with_sums(table: pd.DataFrame) -> pd.DataFrame:
    """Bytes and work counts of all stages together."""
    stages = [column.split(".", 2) for column in table.columns if column.startswith("stage.")]
    sums: dict[str, list[str]] = {}
    for parts in stages:
        if len(parts) == 3 and parts[2] != "milliseconds":
            sums.setdefault("bytes" if parts[2] == "bytes" else WORK + parts[2], []).append(".".join(parts))
    added = {name: table[columns].astype(float).sum(axis=1) for name, columns in sums.items()}
    memory = [record.peak_memory_bytes for record in table["record"]]
    return table.assign(**({"bytes": np.nan} | added), peak_memory_bytes=memory)


def _interval(name: str, intervals: list[tuple[float, float]]) -> dict[str, list[float]]:
    return {f"{name}_low": [low for low, _ in intervals], f"{name}_high": [high for _, high in intervals]}


def _is_measured(column: str) -> bool:
    known = (*COSTS, *METRICS, "noise", "indirect_noise")
    return column.startswith(("stage.", WORK)) or column in known
