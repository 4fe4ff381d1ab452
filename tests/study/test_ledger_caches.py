"""What each claim about caches makes of tables that were made up to hold or not."""

import pandas as pd
import pytest
from experiments.ledger import rehfeld_caches as ledger
from experiments.ledger.claim import DOES_NOT_HOLD, HOLDS, IN_PART, Claim, judge
from experiments.rehfeld import (
    adapted_axes,
    figure_4,
    figure_5,
    figure_6,
    figure_7,
    figure_8,
    gather_or_splat,
    one_ray_a_texel,
    popping,
)
from experiments.rehfeld.sites import CARS, SITES, SPONZA


def rows(columns, **values):
    return pd.DataFrame.from_dict(values, orient="index", columns=columns)


def steps(*milliseconds):
    ours = dict(zip(figure_4.PAPER, milliseconds, strict=True))
    return pd.DataFrame({CARS: ours, SPONZA: dict(zip(ours, milliseconds[::-1], strict=True)), "paper": figure_4.PAPER})


def cars(table):
    """A table of the cars, and of Sponza the same in reverse, which no verdict may follow."""
    turned = table.iloc[::-1].set_axis(table.index)
    return pd.concat({CARS: table, SPONZA: turned})


def pairs(few, usual, coarse):
    return cars(pd.Series({(1024, 16): few, (2048, 16): usual, (4096, 16): usual, (8192, 16): usual, (4096, 8): coarse, (4096, 32): usual}))


def ways(clustered, equidistant):
    return cars(rows(["uncovered", "difference"], clustered=clustered, equidistant=equidistant))


def flips(*values):
    return cars(pd.DataFrame({"flip": values, "own": values, "halves": 0.01}, index=list(figure_7.EXPONENTS)))


def radii(milliseconds, detail):
    return cars(pd.DataFrame({"milliseconds": milliseconds, "detail": detail, "difference": [0.1] * 5}, index=list(figure_8.RADII)))


def clusters(bent, flat):
    index = pd.MultiIndex.from_product([SITES, adapted_axes.WAYS])
    return pd.DataFrame({"clusters": [bent, 100.0, flat, 100.0], "difference": 0.1}, index=index)


def jumps(clustered, kept, floor):
    """The same in every motion."""
    means = {"clustered": clustered, popping.KEEPING: kept, popping.FLOOR: floor}
    index = pd.MultiIndex.from_product([popping.CASES, means])
    of = [{"mean": mean, "beyond": mean - floor, "pops": 0.1, "caches": 500.0} for mean in means.values()]
    return pd.DataFrame(of * len(popping.CASES), index=index)


def missed(ray, cone):
    return pd.DataFrame({"missed": [0.0, ray, cone], "nowhere near": [0.0, ray, cone]}, index=list(one_ray_a_texel.FILLS))


SPLATS = list(gather_or_splat.WAYS)
CASES = [
    ("r1", figure_4, steps(10, 30, 25, 40, 35, 90), HOLDS, 2),
    ("r1", figure_4, steps(100, 30, 5, 5, 90, 20), DOES_NOT_HOLD, 2),
    ("r2", figure_5, pairs(0.2, 0.1, 0.12), HOLDS, 2),
    ("r2", figure_5, pairs(0.13, 0.1, 0.2), IN_PART, 2),
    ("r2", figure_5, pairs(0.11, 0.1, 0.2), DOES_NOT_HOLD, 2),
    ("r3", figure_6, ways((0.0005, 0.1), (0.02, 0.2)), HOLDS, 4),
    ("r3", figure_6, ways((0.01, 0.1), (0.001, 0.1)), DOES_NOT_HOLD, 4),
    ("r4", figure_7, flips(0.1, 0.1, 0.11, 0.2, 0.3), HOLDS, 20),
    ("r4", figure_7, flips(0.1, 0.1, 0.15, 0.2, 0.3), DOES_NOT_HOLD, 20),
    ("r5", figure_8, radii([10, 15, 20, 40, 60], [5, 4, 3, 2, 1]), HOLDS, 4),
    ("r5", figure_8, radii([10, 10, 10, 10, 10], [1, 2, 3, 4, 5]), DOES_NOT_HOLD, 4),
    ("r9", gather_or_splat, pd.DataFrame({"milliseconds": [10, 12, 30]}, index=SPLATS), HOLDS, 2),
    ("r9", gather_or_splat, pd.DataFrame({"milliseconds": [10, 9, 30]}, index=SPLATS), IN_PART, 2),
    ("r10", adapted_axes, clusters(60.0, 80.0), HOLDS, 2),
    ("r10", adapted_axes, clusters(95.0, 80.0), DOES_NOT_HOLD, 2),
    ("r12", popping, jumps(0.06, 0.03, 0.02), HOLDS, 4),
    ("r12", popping, jumps(0.06, 0.055, 0.02), IN_PART, 4),
    ("r12", popping, jumps(0.03, 0.03, 0.02), DOES_NOT_HOLD, 4),
    ("r14", one_ray_a_texel, missed(0.3, 0.01), HOLDS, 1),
    ("r14", one_ray_a_texel, missed(0.3, 0.2), IN_PART, 1),
]  # fmt: skip


@pytest.mark.parametrize(("name", "module", "table", "word", "studies"), CASES)
def test_a_claim_about_caches_is_judged_by_its_table(name, module, table, word, studies, monkeypatch):
    monkeypatch.setattr(module, "table", lambda *records: table)
    checks = getattr(ledger, name)(*[None] * studies)
    assert judge(Claim(name, "", ""), checks).word == word
