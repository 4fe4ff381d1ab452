"""The rows of a bench: what was measured beside its limit, its peer and its target."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any


@dataclasses.dataclass(frozen=True)
class Row:
    """One figure. Milliseconds are the least of the repeats unless the note says otherwise; None where there is none.

    met: None where nothing could be measured; the note says why.
    """

    name: str
    milliseconds: float | None
    limit_milliseconds: float | None  # fewest bytes and operations over this machine's calibration
    peer: str | None
    peer_milliseconds: float | None
    target: str
    met: bool | None
    note: str = ""
    details: dict[str, Any] = dataclasses.field(default_factory=dict)

    @property
    def ratio(self) -> float | None:
        """Measured over limit."""
        if self.milliseconds is None or not self.limit_milliseconds:
            return None
        return self.milliseconds / self.limit_milliseconds


def at_most_times(
    name: str, milliseconds: float, limit: float | None, peer: str, peer_milliseconds: float, times: float, **more: Any
) -> Row:
    """Met where ours takes at most `times` as long as the peer."""
    met = milliseconds <= times * peer_milliseconds
    return Row(name, milliseconds, limit, peer, peer_milliseconds, f"at most {times:g}x the peer", met, **more)


def times_sooner(
    name: str, milliseconds: float, limit: float | None, peer: str, peer_milliseconds: float, times: float, **more: Any
) -> Row:
    """Met where the peer takes at least `times` as long as ours."""
    met = times * milliseconds <= peer_milliseconds
    return Row(name, milliseconds, limit, peer, peer_milliseconds, f"{times:g}x sooner than the peer", met, **more)


def within(name: str, milliseconds: float, limit: float | None, bound: float, scale: float = 1.0, **more: Any) -> Row:
    """Met within `bound` milliseconds of the machine in the targets' table, of which this one needs `scale` times the time."""
    scaled = "" if scale == 1.0 else f" ({bound:g} x {scale:.2f} by calibration)"
    return Row(name, milliseconds, limit, None, None, f"at most {bound * scale:.4g} ms{scaled}", milliseconds <= bound * scale, **more)


def absent(name: str, target: str, reason: str, peer: str | None = None) -> Row:
    """What this machine or this state of the project cannot measure, and why."""
    return Row(name, None, None, peer, None, target, None, note=reason)


def write(rows: Sequence[Row], path: Path) -> None:
    """The rows as a JSON list. ValueError where two have one name."""
    names = [row.name for row in rows]
    if len(set(names)) < len(names):
        raise ValueError(f"every row must have a name of its own, got {sorted(n for n in set(names) if names.count(n) > 1)} twice")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps([dataclasses.asdict(row) for row in rows], indent=1, allow_nan=False) + "\n")


def show(rows: Sequence[Row]) -> None:
    """Prints the rows as a table."""
    from rich.console import Console
    from rich.table import Table

    table = Table()
    for heading in ("name", "ms", "limit ms", "ratio", "peer", "peer ms", "target", "met"):
        table.add_column(heading, justify="right" if heading.endswith("ms") or heading == "ratio" else "left")
    for row in rows:
        verdict = {True: "met", False: "MISSED", None: "not measured"}[row.met]
        numbers = [_short(value) for value in (row.milliseconds, row.limit_milliseconds, row.ratio)]
        table.add_row(row.name, *numbers, row.peer or "", _short(row.peer_milliseconds), row.target, verdict)
    console = Console(width=None if Console().is_terminal else 200)
    console.print(table)
    for row in rows:
        if row.note:
            console.print(f"{row.name}: {row.note}", highlight=False)


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.4g}"
