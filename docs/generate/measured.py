"""What was measured and kept in docs/measured: a file a technique of cost and error, and one of break points.

The first line of a file says on which machine, of which commit and by which command it was made.
"""

from __future__ import annotations

import csv
import dataclasses
from collections import defaultdict
from functools import cache
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "measured"
BREAKS = FOLDER / "breaks.csv"
SWEEP, BISECTIONS = 4, 1  # settings of a failure; how often the first bracket of the tolerance is halved


@dataclasses.dataclass(frozen=True)
class Curve:
    """Of one technique: values of a knob; for each the mean error, the truth's noise, and each kind of work.

    made: machine and commit. command: what measures it again. work: kind -> amount at each value.
    """

    knob: str
    made: str
    command: str
    seeds: int
    values: tuple[float, ...]
    error: tuple[float, ...]
    spread: tuple[float, ...]  # half of the 95 % interval over seeds
    noise: float
    work: dict[str, tuple[float, ...]]
    default: float


def curve_of(name: str) -> Curve | None:
    path = FOLDER / f"{name}.csv"
    if not path.exists():
        return None
    made, _, rest = path.read_text().partition("\n")
    machine, _, command = made.removeprefix("# ").rpartition("; ")
    rows = list(csv.DictReader(rest.splitlines()))
    fixed = ("knob", "value", "default", "seeds", "error", "spread", "noise")
    work = [column for column in rows[0] if column not in fixed]
    return Curve(
        rows[0]["knob"], machine, command, int(rows[0]["seeds"]),
        tuple(float(row["value"]) for row in rows), tuple(float(row["error"]) for row in rows), tuple(float(row["spread"]) for row in rows),
        max(float(row["noise"]) for row in rows),
        {column: tuple(float(row[column]) for row in rows) for column in work}, float(rows[0]["default"]),
    )  # fmt: skip


@cache
def _breaks() -> tuple[str, dict[str, dict[str, str]]]:
    if not BREAKS.exists():
        return "", {}
    made, _, rest = BREAKS.read_text().partition("\n")
    found: dict[str, dict[str, str]] = defaultdict(dict)
    for row in csv.DictReader(rest.splitlines()):
        found[row["technique"]][row["failure"]] = row["text"]
    return made.removeprefix("# "), dict(found)


def breaks_of(name: str) -> dict[str, str]:
    """Failure -> break point in words."""
    return _breaks()[1].get(name, {})


def breaks_made() -> str:
    machine, _, command = _breaks()[0].rpartition("; ")
    again = f"`{command or '.venv/bin/python -m docs.measure breaks'}` measures it"
    told = f"{machine}: {again}" if machine else again
    way = f"{SWEEP} settings from easy to hard, the first bracket halved (times: {BISECTIONS}), one seed; intervals are wide"
    return f"In the method and with the knobs of the picture above: {way}. {told}; [what each failure is](../failures.md)."
