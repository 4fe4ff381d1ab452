"""Figure 5: Number and resolution of the caches, with a Phong exponent of 150."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import COUNTS, RESOLUTIONS, caching, difference, indirect, own
from experiments.rehfeld.sites import by_site, everywhere, tables
from experiments.shared.panels import Image, as_light, groups

EXPONENT = 150.0
USUAL = (4096, 16)
PAIRS = (*((count, USUAL[1]) for count in COUNTS), *((USUAL[0], n) for n in RESOLUTIONS if n != USUAL[1]))


def studies() -> Sequence[ir.Study]:
    shared = [caching(distribute__caches=count, fill__resolution=n) for count, n in PAIRS]
    return everywhere("number and resolution of the caches", [own(), *shared], EXPONENT)


def table(*records: ir.Records) -> pd.Series:
    """(site, number, resolution) -> how far the indirect light is from that of a cache a pixel at 32 x 32."""
    return tables(_table, records)


def _table(records: ir.Records) -> pd.Series:
    exact = indirect(records, 0)
    return pd.Series({pair: difference(indirect(records, 1 + i), exact) for i, pair in enumerate(PAIRS)})


def chart(*records: ir.Records) -> Figure:
    errors = table(*records)
    return groups({site: _shown(one, errors.loc[site]) for site, (one,) in by_site(records).items()}, columns=4)


def _shown(records: ir.Records, errors: pd.Series) -> list[tuple[str, Image]]:
    exact, below = indirect(records, 0), [(USUAL[0], n) for n in RESOLUTIONS]
    shown = []
    for count, n in [*((count, USUAL[1]) for count in COUNTS), *below]:
        name = f"{count:,} caches of {n} x {n}: {errors[(count, n)]:.1%} off"
        shown.append((name, as_light(indirect(records, 1 + PAIRS.index((count, n))), exact)))
    return [*shown, ("a cache of 32 x 32 at every pixel", as_light(exact, exact))]
