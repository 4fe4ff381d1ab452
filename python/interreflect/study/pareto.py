"""Rankings: which configurations are worth having? All read records only.

A configuration (`study/configurations.py`) is a method with its knobs; its seeds are averaged, with intervals on both axes. Rankings
are per scene, camera and bounces. Errors that do not exceed the truth's noise, or that differ by no more than it or than their
intervals, are not ranked: the column `note` says "within noise".
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from interreflect.study.configurations import COSTS, ERRORS, MERIT, NOISE_OF, VIEW, WORK, configurations
from interreflect.study.records import Records

if TYPE_CHECKING:
    import pandas as pd

    from interreflect.study.study import Study

TIMES = ("milliseconds", "milliseconds_p95", "precompute_milliseconds")
WITHIN_NOISE = "within noise"
REFERENCE_POINT = (1e4, 1.0)  # 10 s a frame and an error of 1: what no front is worth beyond; fixed, so that areas compare
TINY = 1e-12  # an error of 0 has no logarithm


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
        fronts.append(_noted(front, y, front.shift(1)))
    return _joined(fronts, records)


def cheapest(records: Records | Study, trials: int = 32, options: Mapping[str, Any] | None = None, **bound: float) -> pd.DataFrame:
    """The fastest configuration whose errors keep within bounds, e.g. `relmse=.01, flip=.1`, per scene, camera and bounces.

    Of records, or of a study's methods with their knobs searched (`ir.search` with so many trials and these options).
    A view where none does has no row. `note` says "within noise" where the truth's noise exceeds the bound or the distance to it.
    """
    limits = _bounds("cheapest", bound)
    records = _found(records, trials, {"relmse": limits.get("relmse", np.inf)} | dict(options or {}))
    return _joined([_fastest(view, limits) for view in _views(records, "milliseconds", *limits)], records)


def best(
    records: Records | Study, milliseconds: float, y: str = "relmse", trials: int = 32, options: Mapping[str, Any] | None = None
) -> pd.DataFrame:
    """The most accurate configuration within a time budget, per scene, camera and bounces.

    Of records, or of a study's methods with their knobs searched (`ir.search` with so many trials and these options).
    `note` says "within noise" where the runner-up's error differs by no more than the truth's noise.
    """
    records = _found(records, trials, {"milliseconds": milliseconds} | dict(options or {}))
    return _joined([_most_accurate(view, milliseconds, y) for view in _views(records, "milliseconds", y)], records)


def equal_time(records: Records, milliseconds: float, y: str = "relmse") -> pd.DataFrame:
    """Every method's most accurate configuration within a time budget, per scene, camera and bounces, most accurate first."""
    picked = []
    for view in _views(records, "milliseconds", y):
        ranked = _stacked([_most_accurate(group, milliseconds, y) for _, group in view.groupby("method", sort=False)], view)
        ranked = ranked.sort_values(y, ascending=y != MERIT, kind="stable")
        picked.append(_noted(ranked, y, ranked.shift(-1)))
    return _joined(picked, records)


def equal_error(records: Records, **bound: float) -> pd.DataFrame:
    """Every method's fastest configuration within error bounds, per scene, camera and bounces, fastest first."""
    limits = _bounds("equal_error", bound)
    picked = []
    for view in _views(records, "milliseconds", *limits):
        ranked = _stacked([_fastest(group, limits) for _, group in view.groupby("method", sort=False)], view)
        picked.append(ranked.sort_values("milliseconds", kind="stable"))
    return _joined(picked, records)


def hypervolume(records: Records, x: str = "milliseconds", y: str = "relmse") -> pd.DataFrame:
    """How much a method's front dominates, per scene, camera and bounces: its area in log-log below the fixed point `REFERENCE_POINT`.

    In decades of time x decades of error; 0 for a method that never gets below the point. ValueError unless `x` is a time and
    `y` an error.
    """
    import moocore
    import pandas as pd

    if x not in TIMES or y not in ERRORS:
        raise ValueError(f"hypervolume needs a time ({', '.join(TIMES)}) and an error ({', '.join(ERRORS)}), got {x!r} and {y!r}")
    rows = []
    for view in _views(records, x, y):
        for method, group in view.groupby("method", sort=False):
            points = np.log10(np.maximum(group[[x, y]].to_numpy(float), TINY))
            below = points[(points < np.log10(REFERENCE_POINT)).all(axis=1)]
            area = float(moocore.hypervolume(below, ref=np.log10(REFERENCE_POINT))) if len(below) else 0.0
            rows.append((*group.iloc[0][VIEW], method, area))
    return pd.DataFrame(rows, columns=[*VIEW, "method", "hypervolume"])


def knee(records: Records, x: str = "milliseconds", y: str = "relmse") -> pd.DataFrame:
    """Where a front bends most, per scene, camera and bounces: beyond it little accuracy is bought with much time.

    The point farthest below the line between the front's ends, both axes logarithmic and scaled to the front [Das 1999]. Views whose
    front has no point below that line have no row. ValueError unless `x` is a cost and `y` an error.
    """
    if (x not in COSTS and not x.startswith(WORK)) or y not in ERRORS:
        raise ValueError(f"a knee needs a cost and an error ({', '.join(ERRORS)}), got {x!r} and {y!r}")
    fronts, picked = pareto(records, x, y), []
    for _, front in fronts.groupby(VIEW, sort=False, dropna=False):
        points = np.log10(np.maximum(front[[x, y]].to_numpy(float), TINY))
        span = np.ptp(points, axis=0)
        if len(front) > 2 and (span > 0).all():
            across = ((points - points.min(axis=0)) / span).sum(axis=1)  # 1 on the line between the ends
            if across.min() < 1:
                picked.append(front.iloc[[int(np.argmin(across))]])
    return _joined(picked, records)


def inefficiency(records: Records, x: str = "milliseconds", y: str = "relmse") -> pd.DataFrame:
    """Error times time of every configuration, least first, per scene, camera and bounces, with its interval.

    Of unbiased estimates it does not change with the samples: half the error for twice the time. ValueError for columns that do not
    rank, or are not a cost and an error.
    """
    if (x not in COSTS and not x.startswith(WORK)) or y not in ERRORS:
        raise ValueError(f"inefficiency needs a cost and an error ({', '.join(ERRORS)}), got {x!r} and {y!r}")
    ranked = []
    for view in _views(records, x, y):
        spread = [_half_width(view, column) / view[column].abs().clip(lower=TINY) for column in (x, y)]
        product, relative = view[x] * view[y], np.hypot(*spread)
        low, high = (product * np.exp(sign * relative) for sign in (-1, 1))
        order = view.assign(inefficiency=product, inefficiency_low=low, inefficiency_high=high).sort_values("inefficiency", kind="stable")
        ranked.append(_noted(order, y, order.head(0).reindex(order.index)))
    return _joined(ranked, records)


def _found(source: Records | Study, trials: int, options: Mapping[str, Any]) -> Records:
    """Records as they are; of a study, those of a search."""
    if isinstance(source, Records):
        return source
    from interreflect.study.search import search

    return search(source, trials=trials, **options).records


def _fastest(view: pd.DataFrame, limits: Mapping[str, float]) -> pd.DataFrame:
    within = view
    for y, limit in limits.items():
        within = within[_minimised(within, y) <= (-limit if y == MERIT else limit)]
    first = next(iter(limits))
    row = within.sort_values(["milliseconds", first], kind="stable").head(1).assign(note="")
    for y, limit in limits.items():
        if y in NOISE_OF and ((limit <= row[NOISE_OF[y]]) | ((limit - row[y]).abs() <= row[NOISE_OF[y]])).any():
            row = row.assign(note=WITHIN_NOISE)
    return row


def _most_accurate(view: pd.DataFrame, milliseconds: float, y: str) -> pd.DataFrame:
    within = view[view["milliseconds"] <= milliseconds]
    ranked = within.sort_values([y, "milliseconds"], ascending=[y != MERIT, True], kind="stable").head(2)
    return _noted(ranked, y, ranked.shift(-1)).head(1)


def _noted(rows: pd.DataFrame, y: str, rivals: pd.DataFrame) -> pd.DataFrame:
    """`rows` with the column `note`; rivals: the row that each is ranked against, NaN where there is none."""
    distance = (_minimised(rows, y) - _minimised(rivals, y)).abs()
    reach = np.hypot(_half_width(rows, y), _half_width(rivals, y))
    unresolved = distance <= reach
    if y in NOISE_OF:
        unresolved |= (rows[y] <= rows[NOISE_OF[y]]) | (distance <= rows[NOISE_OF[y]])
    return rows.assign(note=np.where(unresolved, WITHIN_NOISE, ""))


def _half_width(rows: pd.DataFrame, y: str) -> Any:
    """Of the interval; 0 where one seed gave none."""
    return ((rows[f"{y}_high"] - rows[f"{y}_low"]) / 2).fillna(0.0) if f"{y}_low" in rows else 0.0 * rows[y]


def _views(records: Records, *columns: str) -> list[pd.DataFrame]:
    for column in columns:
        if column not in (*COSTS, *ERRORS, MERIT) and not column.startswith(WORK):
            raise ValueError(f"rankings need one of {', '.join((*COSTS, *ERRORS, MERIT, WORK + '<count>'))}, got {column!r}")
    table = configurations(records)
    for column in columns:
        if column not in table:
            raise ValueError(
                f"no record has {column!r}; work that was counted: {', '.join(str(c) for c in table if str(c).startswith(WORK))}"
            )
        table = table[np.isfinite(table[column].astype(float))]
    return [view for _, view in table.groupby(VIEW, sort=False, dropna=False)]


def _bounds(function: str, given: dict[str, float]) -> dict[str, float]:
    allowed = (*ERRORS, MERIT)
    if not given or not set(given) <= set(allowed):
        raise TypeError(f"{function} takes bounds of {', '.join(allowed)}, got {sorted(given)}")
    return given


def _minimised(rows: pd.DataFrame, column: str) -> Any:
    return -rows[column] if column == MERIT else rows[column]


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
