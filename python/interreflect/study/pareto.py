"""Rankings: which configurations are worth having? All read records only.

A configuration is a method with its knobs; its seeds are averaged. Rankings are per scene, camera and bounces. The truth has
noise of its own: errors that do not exceed it, or that differ by no more than it, are not ranked: the column `note` says
"within noise".
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.study.records import METRICS, OK, Records

if TYPE_CHECKING:
    import pandas as pd

VIEW = ["scene", "camera", "bounces"]
COSTS = ("milliseconds", "milliseconds_p95", "precompute_milliseconds")
NOISE_OF = {  # an error that the truth's noise bounds -> the column that holds that noise
    "relmse": "noise",
    "trimmed_relmse": "noise",
    "indirect_relmse": "indirect_noise",
    "indirect_trimmed_relmse": "indirect_noise",
}
ERRORS = (*NOISE_OF, "flip")
MERIT = "ssim"  # better where larger
WITHIN_NOISE = "within noise"
REFERENCE_POINT = (1e4, 1.0)  # 10 s a frame and an error of 1: what no front is worth beyond; fixed, so that areas compare
TINY = 1e-12  # an error of 0 has no logarithm
PER_SEED = ("seed", "status", "failure", "key")  # columns of cells that configurations do not have


def configurations(records: Records) -> pd.DataFrame:
    """A row per view and configuration: measured columns averaged over its seeds (the median of times), `seeds` their number.

    Cells that failed or are not finite are left out, and so are configurations of which any seed did.
    """
    by = [*VIEW, "configuration"]
    table = records.table.assign(configuration=[record.configuration for record in records])
    failed = table.assign(failed=table["status"] != OK).groupby(by, sort=False)["failed"].transform("any")
    kept = table[~failed.astype(bool)].drop(columns=list(PER_SEED))
    measured = [name for name in kept.columns if name not in records.knob_columns and _is_measured(name)]
    how = dict.fromkeys(kept.columns.difference(by, sort=False), "first")
    how |= {name: "median" if "milliseconds" in name else "mean" for name in measured}
    grouped = kept.astype(dict.fromkeys(measured, float)).groupby(by, sort=False)
    return grouped.agg(how).assign(seeds=grouped.size()).reset_index()


def pareto(records: Records, x: str = "milliseconds", y: str = "relmse") -> pd.DataFrame:
    """The configurations that no other one beats in both `x` and `y`, per scene, camera and bounces, fastest first.

    `note` says "within noise" where the error does not exceed the truth's noise, or where the gain in error over the faster
    neighbour on the front does not. ValueError for a column that does not rank.
    """
    import moocore

    fronts = []
    for view in _views(records, x, y):
        points = np.column_stack([_minimised(view, x), _minimised(view, y)])
        front = view[moocore.is_nondominated(points, keep_weakly=True)].sort_values([x, y], kind="stable")
        fronts.append(_noted(front, y, _minimised(front, y).shift(1)))
    return _joined(fronts, records)


def cheapest(records: Records, **bound: float) -> pd.DataFrame:
    """The fastest configuration whose error keeps within a bound, e.g. `relmse=.01`, per scene, camera and bounces.

    A view where none does has no row. `note` says "within noise" where the truth's noise exceeds the bound or the distance to it.
    """
    y, limit = _bound("cheapest", bound, (*ERRORS, MERIT))
    return _joined([_fastest(view, y, limit) for view in _views(records, "milliseconds", y)], records)


def best(records: Records, milliseconds: float, y: str = "relmse") -> pd.DataFrame:
    """The most accurate configuration within a time budget, per scene, camera and bounces.

    `note` says "within noise" where the runner-up's error differs by no more than the truth's noise.
    """
    return _joined([_most_accurate(view, milliseconds, y) for view in _views(records, "milliseconds", y)], records)


def equal_time(records: Records, milliseconds: float, y: str = "relmse") -> pd.DataFrame:
    """Every method's most accurate configuration within a time budget, per scene, camera and bounces, most accurate first."""
    picked = []
    for view in _views(records, "milliseconds", y):
        ranked = _stacked([_most_accurate(group, milliseconds, y) for _, group in view.groupby("method", sort=False)], view)
        ranked = ranked.sort_values(y, ascending=y != MERIT, kind="stable")
        picked.append(_noted(ranked, y, _minimised(ranked, y).shift(-1)))
    return _joined(picked, records)


def equal_error(records: Records, **bound: float) -> pd.DataFrame:
    """Every method's fastest configuration within an error bound, per scene, camera and bounces, fastest first."""
    y, limit = _bound("equal_error", bound, (*ERRORS, MERIT))
    picked = []
    for view in _views(records, "milliseconds", y):
        ranked = _stacked([_fastest(group, y, limit) for _, group in view.groupby("method", sort=False)], view)
        picked.append(ranked.sort_values("milliseconds", kind="stable"))
    return _joined(picked, records)


def hypervolume(records: Records, x: str = "milliseconds", y: str = "relmse") -> pd.DataFrame:
    """How much a method's front dominates, per scene, camera and bounces: its area in log-log below the fixed point `REFERENCE_POINT`.

    In decades of time x decades of error; 0 for a method that never gets below the point. ValueError unless `x` is a time and
    `y` an error.
    """
    import moocore
    import pandas as pd

    if x not in COSTS or y not in ERRORS:
        raise ValueError(f"hypervolume needs a time ({', '.join(COSTS)}) and an error ({', '.join(ERRORS)}), got {x!r} and {y!r}")
    rows = []
    for view in _views(records, x, y):
        for method, group in view.groupby("method", sort=False):
            points = np.log10(np.maximum(group[[x, y]].to_numpy(float), TINY))
            below = points[(points < np.log10(REFERENCE_POINT)).all(axis=1)]
            area = float(moocore.hypervolume(below, ref=np.log10(REFERENCE_POINT))) if len(below) else 0.0
            rows.append((*group.iloc[0][VIEW], method, area))
    return pd.DataFrame(rows, columns=[*VIEW, "method", "hypervolume"])


def _fastest(view: pd.DataFrame, y: str, limit: float) -> pd.DataFrame:
    within = view[_minimised(view, y) <= (-limit if y == MERIT else limit)]
    row = within.sort_values(["milliseconds", y], kind="stable").head(1)
    return _noted(row, y, limit + 0 * _minimised(row, y)) if y in NOISE_OF else _noted(row, y, None)


def _most_accurate(view: pd.DataFrame, milliseconds: float, y: str) -> pd.DataFrame:
    within = view[view["milliseconds"] <= milliseconds]
    ranked = within.sort_values([y, "milliseconds"], ascending=[y != MERIT, True], kind="stable").head(2)
    return _noted(ranked, y, _minimised(ranked, y).shift(-1)).head(1)


def _noted(rows: pd.DataFrame, y: str, rival: Any) -> pd.DataFrame:
    """`rows` with the column `note`; rival: the error that each row's is ranked against, NaN where there is none."""
    rows = rows.copy()
    rows["note"] = ""
    if y in NOISE_OF:
        noise, error = rows[NOISE_OF[y]], rows[y]
        unresolved = (error <= noise) | ((rival - error).abs() <= noise)
        rows.loc[unresolved, "note"] = WITHIN_NOISE
    return rows


def _views(records: Records, x: str, y: str) -> list[pd.DataFrame]:
    for column, allowed in ((x, (*COSTS, *ERRORS, MERIT)), (y, (*COSTS, *ERRORS, MERIT))):
        if column not in allowed:
            raise ValueError(f"rankings need one of {', '.join(allowed)}, got {column!r}")
    table = configurations(records)
    table = table[np.isfinite(table[x].astype(float)) & np.isfinite(table[y].astype(float))]
    return [view for _, view in table.groupby(VIEW, sort=False, dropna=False)]


def _bound(function: str, bound: dict[str, float], allowed: tuple[str, ...]) -> tuple[str, float]:
    if len(bound) != 1 or not set(bound) <= set(allowed):
        raise TypeError(f"{function} takes one bound, one of {', '.join(allowed)}, got {sorted(bound)}")
    return next(iter(bound.items()))


def _minimised(rows: pd.DataFrame, column: str) -> Any:
    return -rows[column] if column == MERIT else rows[column]


def _is_measured(column: str) -> bool:
    return column.startswith("stage.") or column in (*COSTS, *METRICS, "noise", "indirect_noise")


def _stacked(parts: list[pd.DataFrame], like: pd.DataFrame) -> pd.DataFrame:
    import pandas as pd

    return pd.concat(parts) if parts else like.head(0)


def _joined(parts: list[pd.DataFrame], records: Records) -> pd.DataFrame:
    """One table with the columns that matter first, numbered anew."""
    import pandas as pd

    parts = [part for part in parts if len(part)]
    table = pd.concat(parts, ignore_index=True) if parts else configurations(records).head(0).assign(note="")
    first = [*VIEW, "method", "configuration", "milliseconds", "relmse", "note"]
    return table[[*first, *(name for name in table.columns if name not in first)]]
