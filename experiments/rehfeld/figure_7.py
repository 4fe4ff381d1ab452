"""Figure 7: Indirect light with different Phong exponents."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.rehfeld.caches import caching, cars, difference, indirect
from experiments.shared.panels import as_light, panels

EXPONENTS = (10.0, 50.0, 150.0, 500.0, 1000.0)
SIZE = (436, 286)
REFERENCE = ir.Reference(noise=1e-2, max_spp=128)


def studies() -> Sequence[ir.Study]:
    """A study per exponent: each is a scene of its own."""
    return [cars("exponents", [caching()], exponent, size=SIZE, reference=REFERENCE) for exponent in EXPONENTS]


def table(*records: ir.Records) -> pd.DataFrame:
    """A row per exponent: FLIP and relative difference of the indirect light from one-bounce truth, and the energy's ratio."""
    rows = {}
    for exponent, one in zip(EXPONENTS, records, strict=True):
        light, truth = indirect(one, 0), one.truth(one[0])[1]
        ratio = float(ir.metrics.energy_ratio(light, truth))
        rows[exponent] = {"flip": float(ir.metrics.flip(light, truth)), "difference": difference(light, truth), "energy": ratio}
    return pd.DataFrame(rows).T


def chart(*records: ir.Records) -> Figure:
    found = table(*records)
    ours, truths = [], []
    for exponent, one in zip(EXPONENTS, records, strict=True):
        truth = one.truth(one[0])[1]
        ours.append((f"exponent {exponent:g}: FLIP {found.loc[exponent, 'flip']:.3f}", as_light(indirect(one, 0), truth)))
        truths.append(("path-traced truth, one bounce", as_light(truth, truth)))
    return panels([*ours, *truths], columns=len(EXPONENTS), width=3.2)
