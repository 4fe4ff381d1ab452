"""Figure 5: Number and resolution of the caches, with a Phong exponent of 150."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import COUNTS, RESOLUTIONS, caching, cars, difference, indirect, own
from experiments.shared.panels import as_light, panels

EXPONENT = 150.0
USUAL = (4096, 16)
PAIRS = (*((count, USUAL[1]) for count in COUNTS), *((USUAL[0], n) for n in RESOLUTIONS if n != USUAL[1]))


def studies() -> Sequence[ir.Study]:
    shared = [caching(distribute__caches=count, fill__resolution=n) for count, n in PAIRS]
    return [cars("number and resolution of the caches", [own(), *shared], EXPONENT)]


def table(records: ir.Records) -> pd.Series:
    """(number, resolution) -> how far the indirect light is from that of a cache a pixel at 32 x 32."""
    exact = indirect(records, 0)
    return pd.Series({pair: difference(indirect(records, 1 + i), exact) for i, pair in enumerate(PAIRS)})


def chart(records: ir.Records) -> Figure:
    exact, errors = indirect(records, 0), table(records)

    def shown(pair: tuple[int, int]) -> tuple[str, object]:
        name = f"{pair[0]:,} caches of {pair[1]} x {pair[1]}: {errors[pair]:.1%} off"
        return name, as_light(indirect(records, 1 + PAIRS.index(pair)), exact)

    below = [(USUAL[0], n) for n in RESOLUTIONS]
    pictures = [*(shown((count, USUAL[1])) for count in COUNTS), *map(shown, below)]
    return panels([*pictures, ("a cache of 32 x 32 at every pixel", as_light(exact, exact))], columns=4)
