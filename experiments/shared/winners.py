"""Who wins within a budget: of a study's records, and of plays in motion; by how much, and whether that can be told from noise."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from typing import Any

import numpy as np
import pandas as pd

import interreflect as ir
from experiments.shared.contenders import BLACK

BUDGETS = (50, 200, 1000)  # ms
STILL_ERRORS = ("relmse", "flip")
VIEW = ["scene", "light", "kind", "budget", "by"]
WITHIN_NOISE = "within noise"


def winners_of(records: ir.Records, names: Sequence[str]) -> pd.DataFrame:
    """Within each budget and by each error, every method's best setting, best first. names: of the study's methods, in its order."""
    from interreflect.study.configurations import configurations

    seeds = len({record.seed for record in records})
    named = {record.configuration: names[index // seeds] for index, record in enumerate(records)}
    table = configurations(records)
    table["setting"] = table["configuration"].map(named)
    return ranked(table, STILL_ERRORS, {"relmse": "noise"})


def winners_in_motion(moving: pd.DataFrame) -> pd.DataFrame:
    """The same of `in_motion`'s rows, by temporal error too: there only of what is nearer to the truth than direct light alone, which
    is as steady as can be."""
    played = moving[moving["failure"] == ""]
    black = played.loc[played["setting"] == BLACK, "relmse"].min()
    nearer = played[played["relmse"] < black] if np.isfinite(black) else played
    parts = [ranked(played, STILL_ERRORS, {"relmse": "truth_noise"}), ranked(nearer, ("temporal",), {"temporal": "truth_temporal"})]
    return pd.concat(parts, ignore_index=True)


def ranked(table: pd.DataFrame, errors: Sequence[str], noises: dict[str, str]) -> pd.DataFrame:
    """A row per budget, error and method; `place`; `times_best`: its error over the best's; `note`: "within noise" where its distance to
    the next in place is no more than the truth's noise or their intervals together."""
    rows: list[dict[str, Any]] = []
    for budget in BUDGETS:
        within = table[table["milliseconds"] <= budget]
        for by in errors:
            best = within.sort_values([by, "milliseconds"], kind="stable").groupby("method", sort=False).head(1)
            for place, (_, row) in enumerate(best.iterrows(), 1):
                following = best.iloc[place] if place < len(best) else None
                rows.append(_row(row, by, budget, place, best.iloc[0][by]) | {"note": _note(row, following, by, noises.get(by))})
    return pd.DataFrame(rows)


def _row(row: Any, by: str, budget: int, place: int, least: float) -> dict[str, Any]:
    """Of an error of 0 or below (the truth's noise is subtracted) no multiple can be told."""
    who = {"budget": budget, "by": by, "place": place, "setting": row["setting"], "method": row["method"]}
    times = {f"milliseconds{end}": row[f"milliseconds{end}"] for end in ("", "_low", "_high")}
    error = {"error": row[by], "low": row[f"{by}_low"], "high": row[f"{by}_high"]}
    return who | times | error | {"times_best": row[by] / least if least > 0 else np.nan}


def _note(row: Any, following: Any, by: str, noise: str | None) -> str:
    if following is None:
        return ""
    reach = np.hypot(*(np.nan_to_num((one[f"{by}_high"] - one[f"{by}_low"]) / 2) for one in (row, following)))
    limit = max(reach, 0.0 if noise is None else float(row[noise]))
    return WITHIN_NOISE if following[by] - row[by] <= limit else ""


def table_of_winners(found: pd.DataFrame) -> pd.DataFrame:
    """A row per scene, light, kind, budget and error: the winner, what it takes and its error; the next method, and how far behind."""
    rows = []
    for view, group in found.groupby([name for name in VIEW if name in found], sort=False):
        first = group.iloc[0]
        rows.append(
            dict(zip([name for name in VIEW if name in found], view, strict=True))
            | {"winner": first["setting"], "ms": round(first["milliseconds"], 1), "error": _with_interval(first)}
            | {"next": group.iloc[1]["setting"] if len(group) > 1 else "none", "times": _times(group), "note": first["note"]}
        )
    return pd.DataFrame(rows)


def _with_interval(row: Any) -> str:
    return f"{row['error']:.3g} [{row['low']:.3g}, {row['high']:.3g}]"


def _times(group: pd.DataFrame) -> str:
    return f"{group.iloc[1]['times_best']:.2f}" if len(group) > 1 and np.isfinite(group.iloc[1]["times_best"]) else ""


def wins(found: pd.DataFrame) -> pd.DataFrame:
    """How often each method is first: a row per method, a column per light, kind, budget and error; ties within noise count for all that
    noise does not tell from the first."""
    counts: dict[tuple[Any, ...], dict[str, int]] = {}
    for view, group in found.groupby(VIEW, sort=False):
        of = counts.setdefault(tuple(view)[1:], {})
        for method in tied(group)["method"]:
            of[method] = of.get(method, 0) + 1
    return pd.DataFrame(counts).rename_axis(columns=VIEW[1:]).fillna(0).astype(int)


def tied(group: pd.DataFrame) -> pd.DataFrame:
    """The first, and those after it as long as each is within noise of the one before."""
    apart = (group["note"] != WITHIN_NOISE).to_numpy()
    return group.iloc[: int(np.argmax(apart)) + 1 if apart.any() else len(group)]


def as_markdown(found: pd.DataFrame) -> str:
    """How often each method wins, and the whole table."""
    counts = wins(found)
    counts.columns = [" ".join(map(str, column)) for column in counts.columns]
    parts = [("How often each method is first, ties within noise counted for all", counts.reset_index(names="method"))]
    parts.append((f"Who wins where; {BLACK!r} has no indirect light at all", table_of_winners(found)))
    return "\n\n".join(f"## {title}\n\n{_as_table(table)}" for title, table in parts) + "\n"


def _as_table(table: pd.DataFrame) -> str:
    lines = ["| " + " | ".join(map(str, table.columns)) + " |", "|" + "---|" * len(table.columns)]
    return "\n".join([*lines, *("| " + " | ".join(str(value).replace("|", "\\|") for value in row) + " |" for row in table.to_numpy())])


class InMotion:
    """What a page shows of plays in motion."""

    def __init__(self, moving: pd.DataFrame) -> None:
        self.moving = moving

    def _repr_html_(self) -> str:
        words = "A camera and a light move; errors are means over the frames after the first, temporal errors beside the truth's own."
        return f"<p>{escape(words)}</p>{self.moving.to_html(index=False, float_format=lambda number: f'{number:.4g}')}"


def front_of(moving: pd.DataFrame) -> InMotion:
    return InMotion(moving)
