"""What the ledger is made of: a claim of a paper, the checks it is broken into, and the verdict that follows from them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import interreflect as ir

HOLDS, IN_PART, DOES_NOT_HOLD = "holds", "holds in part", "does not hold"
ANSWERED, NOT_YET = "answered", "not yet testable"


@dataclass(frozen=True)
class Check:
    """One sentence that is true or not, with what was measured. `holds` is None for a number that answers an open question."""

    sentence: str
    measured: str
    holds: bool | None


def below(sentence: str, measured: float, bound: float, unit: str = "") -> Check:
    """Is the measured number at most the bound?"""
    return Check(sentence, f"{measured:.3g}{unit} (bound {bound:.3g}{unit})", measured <= bound)


def above(sentence: str, measured: float, bound: float, unit: str = "") -> Check:
    """Is the measured number at least the bound?"""
    return Check(sentence, f"{measured:.3g}{unit} (at least {bound:.3g}{unit})", measured >= bound)


def told(sentence: str, measured: str) -> Check:
    """A number without a verdict."""
    return Check(sentence, measured, None)


@dataclass(frozen=True)
class Claim:
    """place: figure, table or section. studies: what it is measured on. measure: records of these studies, in order -> checks.

    missing: in plain words, what is lacking where a claim cannot be tested yet; then there are no studies.
    """

    name: str
    place: str
    text: str
    studies: Callable[[], Sequence[ir.Study]] = tuple
    measure: Callable[..., Sequence[Check]] = lambda: ()
    missing: str = ""


@dataclass(frozen=True)
class Verdict:
    claim: Claim
    word: str
    checks: tuple[Check, ...] = ()
    reason: str = ""


def judge(claim: Claim, checks: Sequence[Check]) -> Verdict:
    """Holds where every check does, in part where some do, not where none does; answered where all only tell numbers."""
    judged = [check for check in checks if check.holds is not None]
    if not checks:
        raise ValueError(f"{claim.name}: no checks")
    if not judged:
        return Verdict(claim, ANSWERED, tuple(checks))
    failed = [check.sentence for check in judged if not check.holds]
    word = HOLDS if not failed else DOES_NOT_HOLD if len(failed) == len(judged) else IN_PART
    return Verdict(claim, word, tuple(checks), "not: " + "; ".join(failed) if failed else "")
