"""The ledger written down: a table in Markdown, a page, and CSV with a row per check."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from html import escape

from experiments.ledger.claim import Verdict

PAPERS = {
    "F": "Freed 2018, Tessellated voxelization and warped grids",
    "R": "Rehfeld et al. 2014, Clustered pre-convolved radiance caching",
    "J": "Jendersie et al. 2016, Precomputed illuminance composition",
    "W": "Weinzierl-Heigl 2013, Virtual area lights",
}
NOTES = (
    "Times are those of this machine's processor, not of the papers' graphics cards: ratios and what depends on what are compared.",
    "Freed's normal mapping is left out: our scenes have no normal maps.",
    "A visual claim's metric and bound stand beside its checks in experiments/ledger and were written down before the first run.",
)
RECORDED = "Nothing was measured for this page: it rests on records of earlier runs, whichever commit made them."
COLUMNS = ("claim", "paper", "place", "text", "verdict", "check", "measured", "holds", "reason", "command")
STYLE = (
    "body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 76em; padding: 0 1em; color: #222 } "
    "table { border-collapse: collapse; table-layout: fixed; width: 100% } "
    "td, th { border-top: 1px solid #ccc; padding: .4em .6em; text-align: left; "
    "vertical-align: top } code { font-size: .85em; white-space: nowrap } ul { margin: 0; padding-left: 1.1em } "
    ".holds { background: #dff0df } .holds-in-part { background: #fbf1d2 } .does-not-hold { background: #f8dcdc } "
    ".answered { background: #dfe9f6 } .not-yet-testable { background: #eee }"
)

WIDTHS = "".join(f'<col style="width: {share}%">' for share in (27, 20, 34, 19))


def paper_of(name: str) -> str:
    return PAPERS[name[0]]


def command_of(name: str) -> str:
    """What measures a claim's numbers."""
    return f"./run figures ledger/{name}"


def mark(holds: bool | None) -> str:
    return "" if holds is None else "yes: " if holds else "no: "


def as_text(one: Verdict) -> str:
    """One claim for a terminal."""
    head = f"{one.claim.name:>4} ({one.claim.place}) {one.word.upper()}: {one.claim.text}"
    numbers = [f"       {mark(check.holds)}{check.sentence}: {check.measured}" for check in one.checks]
    return "\n".join([head, *numbers, *([f"       {one.reason}"] if one.reason else [])])


def as_markdown(verdicts: Sequence[Verdict], notes: Sequence[str] = NOTES) -> str:
    """A table: claim, verdict, our numbers, reason, command."""
    lines = [
        "# Reproduction ledger",
        "",
        *(f"- {note}" for note in notes),
        "",
        "| claim | where | verdict | our numbers | reason | command |",
        "|---|---|---|---|---|---|",
    ]
    for one in verdicts:
        name = one.claim.name
        numbers = "<br>".join(f"{mark(check.holds)}{check.sentence}: {check.measured}" for check in one.checks)
        cells = (f"**{name}** {one.claim.text}", one.claim.place, f"*{one.word}*", numbers, one.reason, f"`{command_of(name)}`")
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def as_csv(verdicts: Sequence[Verdict]) -> str:
    """A row per check, and one for a claim without any. holds: yes, no, or empty for a number that only tells."""
    text = io.StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(COLUMNS)
    for one in verdicts:
        claim = one.claim
        head, tail = (claim.name, paper_of(claim.name), claim.place, claim.text, one.word), (one.reason, command_of(claim.name))
        for check in one.checks:
            rows.writerow((*head, check.sentence, check.measured, {None: "", True: "yes", False: "no"}[check.holds], *tail))
        if not one.checks:
            rows.writerow((*head, "", "", "", *tail))
    return text.getvalue()


def as_html(verdicts: Sequence[Verdict], notes: Sequence[str] = NOTES) -> str:
    """A page: a table per paper, and how many claims have which verdict."""
    counts = {word: sum(one.word == word for one in verdicts) for word in dict.fromkeys(one.word for one in verdicts)}
    parts = [
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Reproduction ledger</title><style>{STYLE}</style>',
        "<h1>Reproduction ledger</h1>",
        "<p>" + ", ".join(f"{count} {escape(word)}" for word, count in counts.items()) + ".</p>",
        "<ul>" + "".join(f"<li>{escape(note)}" for note in notes) + "</ul>",
    ]
    for letter, paper in PAPERS.items():
        rows = [_row(one) for one in verdicts if one.claim.name[0] == letter]
        if rows:
            head = f"<table>{WIDTHS}<tr><th>claim<th>verdict<th>our numbers<th>command</tr>"
            parts.append(f"<h2>{escape(paper)}</h2>{head}{''.join(rows)}</table>")
    return "\n".join(parts) + "\n"


def _row(one: Verdict) -> str:
    numbers = "".join(f"<li>{escape(mark(check.holds) + check.sentence)}: {escape(check.measured)}" for check in one.checks)
    claim = f"<b>{one.claim.name}</b> ({escape(one.claim.place)}) {escape(one.claim.text)}"
    reason = f"<br>{escape(one.reason)}" if one.reason else ""
    return (
        f'<tr class="{one.word.replace(" ", "-")}"><td>{claim}<td><b>{escape(one.word)}</b>{reason}'
        f"<td><ul>{numbers}</ul><td><code>{command_of(one.claim.name)}</code></tr>"
    )
