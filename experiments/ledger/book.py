"""Judges every claim from its records and writes the ledger down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import interreflect as ir
from experiments.ledger import freed, jendersie, rehfeld, rehfeld_caches, weinzierl_heigl
from experiments.ledger.claim import NOT_YET, Claim, Verdict, judge
from experiments.shared.keep import FOLDER, records_of

CLAIMS: tuple[Claim, ...] = (
    *freed.CLAIMS,
    *sorted((*rehfeld.CLAIMS, *rehfeld_caches.CLAIMS), key=lambda claim: int(claim.name[1:])),
    *jendersie.CLAIMS,
    *weinzierl_heigl.CLAIMS,
)
NOTES = (
    "Times are those of this machine's processor, not of the papers' graphics cards: ratios and what depends on what are compared.",
    "Freed's normal mapping is left out: our scenes have no normal maps.",
    "A visual claim's metric and bound stand beside its checks in experiments/ledger and were written down before the first run.",
)


def verdict(claim: Claim, records: Callable[[ir.Study], ir.Records] = records_of) -> Verdict:
    """What the records say; not yet testable where a part, or the scene, is lacking."""
    if claim.missing:
        return Verdict(claim, NOT_YET, reason=f"missing: {claim.missing}")
    try:
        studies = claim.studies()
    except FileNotFoundError as error:
        return Verdict(claim, NOT_YET, reason=f"the scene is not here: {error}")
    return judge(claim, claim.measure(*(records(study) for study in studies)))


def as_markdown(verdicts: Sequence[Verdict]) -> str:
    """A table: claim, verdict, our numbers, reason."""
    lines = [
        "# Reproduction ledger",
        "",
        *(f"- {note}" for note in NOTES),
        "",
        "| claim | where | verdict | our numbers | reason |",
        "|---|---|---|---|---|",
    ]
    for one in verdicts:
        numbers = "<br>".join(f"{mark(check.holds)}{check.sentence}: {check.measured}" for check in one.checks)
        cells = (f"**{one.claim.name}** {one.claim.text}", one.claim.place, f"*{one.word}*", numbers, one.reason)
        lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def as_text(one: Verdict) -> str:
    """One claim for a terminal."""
    head = f"{one.claim.name:>4} ({one.claim.place}) {one.word.upper()}: {one.claim.text}"
    numbers = [f"       {mark(check.holds)}{check.sentence}: {check.measured}" for check in one.checks]
    return "\n".join([head, *numbers, *([f"       {one.reason}"] if one.reason else [])])


def mark(holds: bool | None) -> str:
    return "" if holds is None else "yes: " if holds else "no: "


def write(folder: Path = FOLDER, names: Sequence[str] = ()) -> Path:
    """Prints the ledger claim by claim and writes all of it to ledger.md. names: only these claims (nothing is written then)."""
    verdicts = []
    for claim in CLAIMS:
        if not names or claim.name in names:
            verdicts.append(verdict(claim))
            print(as_text(verdicts[-1]), flush=True)
    path = folder / "ledger.md"
    if not names:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(as_markdown(verdicts))
    return path
