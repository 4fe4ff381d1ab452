"""Judges every claim and open question from its records and writes the ledger down."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import interreflect as ir
from experiments.ledger import freed, jendersie, rehfeld, rehfeld_caches, weinzierl_heigl
from experiments.ledger.claim import NOT_YET, Claim, Verdict, judge
from experiments.ledger.page import NOTES, RECORDED, as_csv, as_html, as_markdown, as_text, command_of
from experiments.shared.keep import FOLDER, NotRecorded, recorded, records_of

CLAIMS: tuple[Claim, ...] = (
    *freed.CLAIMS,
    *sorted((*rehfeld.CLAIMS, *rehfeld_caches.CLAIMS), key=lambda claim: int(claim.name[1:])),
    *jendersie.CLAIMS,
    *weinzierl_heigl.CLAIMS,
)


def verdict(claim: Claim, records: Callable[[ir.Study], ir.Records] = records_of) -> Verdict:
    """What the records say; not yet testable where a part, the scene, or a record that nobody may measure now, is lacking."""
    if claim.missing:
        return Verdict(claim, NOT_YET, reason=f"missing: {claim.missing}")
    try:
        return judge(claim, claim.measure(*(records(study) for study in claim.studies())))
    except FileNotFoundError as error:
        return Verdict(claim, NOT_YET, reason=f"the scene is not here: {error}")
    except NotRecorded as lacking:
        return Verdict(claim, NOT_YET, reason=f"no records yet: {command_of(claim.name)} ({lacking})")


def write(folder: Path = FOLDER, names: Sequence[str] = (), measuring: bool = True) -> Path:
    """Prints the ledger claim by claim and writes all of it to ledger.md, ledger.html and ledger.csv.

    names: only these claims (nothing is written then). measuring: measure what is missing; else judge what is recorded.
    """
    verdicts = []
    for claim in CLAIMS:
        if not names or claim.name in names:
            verdicts.append(verdict(claim, lambda study: (records_of if measuring else recorded)(study, folder)))
            print(as_text(verdicts[-1]), flush=True)
    page = folder / "ledger.html"
    if not names:
        folder.mkdir(parents=True, exist_ok=True)
        notes = NOTES if measuring else (*NOTES, RECORDED)
        page.write_text(as_html(verdicts, notes))
        (folder / "ledger.md").write_text(as_markdown(verdicts, notes))
        (folder / "ledger.csv").write_text(as_csv(verdicts))
    return page
