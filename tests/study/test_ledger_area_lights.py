"""What each claim about virtual area lights makes of tables that were made up to hold or not."""

import pandas as pd
import pytest
from experiments.ledger import weinzierl_heigl as ledger
from experiments.ledger.claim import DOES_NOT_HOLD, HOLDS, IN_PART, Claim, judge
from experiments.weinzierl_heigl import figure_1, figure_3, figure_4, figure_7, figure_8, figure_9, table_1

STEPS = [*table_1.STEPS, table_1.COMPLETE]


def steps(*complete):
    """The paper's columns say the opposite, which no verdict may follow."""
    found = {}
    for name, ours, paper in zip(table_1.NAMES, complete, complete[::-1], strict=True):
        found[name, "ours"] = dict.fromkeys(STEPS, ours)
        found[name, "paper"] = dict.fromkeys(STEPS, paper)
    return pd.DataFrame(found)


def errors(few, many):
    return pd.DataFrame({"flip": [few, many], "relmse": [few, many]}, index=list(table_1.NAMES))


def points(off, spots):
    """128 area lights take as long as 512 points; 1,024 and more take longer, and are right."""
    index = [*(f"{count} points" for count in figure_7.COUNTS), *figure_7.CHANGES]
    milliseconds = [10.0, 15.0, 25.0, 50.0, 100.0, 200.0, 55.0, 55.0, 55.0]  # the last two are told and not judged
    columns = {"milliseconds": milliseconds, "frame": milliseconds, "off": [0.4] * 4 + [0.0] * 2 + [off, 0.0, 0.0]}
    return pd.DataFrame({**columns, "dull_off": columns["off"], "spots": [0.02] * 4 + [0.0] * 2 + [spots, 0.0, 0.0]}, index=index)


def looked_up(simple, pcss):
    names = list(figure_8.WAYS)
    rows = {name: 2 * row for name, row in zip(names, (simple, pcss, (0.0, 0.0)), strict=True)}
    return pd.DataFrame.from_dict(rows, orient="index", columns=["off", "jagged", "dull_off", "dull_jagged"])


def times(simple, pcss):
    return pd.DataFrame({"simple": simple, "PCSS": pcss}, index=list(figure_9.COUNTS))


def holes(before, after):
    told = dict.fromkeys(figure_4.FURTHER, (0.2, 0.0, 0.2))
    return pd.DataFrame.from_dict(
        {figure_4.BEFORE: before, figure_4.AFTER: after, **told}, orient="index", columns=["holes", "closed", "empty"]
    )  # fmt: skip


def moved(warped, *distances):
    share = pd.Series({**dict.fromkeys(figure_3.SEEDS, 0.2), "warped by the specular term": warped, "texels": 0.2})
    return share, pd.DataFrame({"distance": distances, "moved": 0.1}, index=range(1, len(distances) + 1))


def corner(points, bounded, energy):
    columns = ["energy", "brightest", "off"]
    return pd.DataFrame.from_dict(
        {"points": (1.0, points, 0.2), "points, bounded": (energy, bounded, 0.1)}, orient="index", columns=columns
    )


def word(name, *records):
    return judge(Claim(name, "", ""), getattr(ledger, name)(*records)).word


@pytest.mark.parametrize(("complete", "off", "expected"), [
    ((20.0, 50.0), (0.1, 0.1), HOLDS),
    ((20.0, 50.0), (0.2, 0.1), IN_PART),
    ((40.0, 50.0), (0.2, 0.1), DOES_NOT_HOLD),
])  # fmt: skip
def test_few_lights_must_be_fast_and_right(complete, off, expected, monkeypatch):
    monkeypatch.setattr(table_1, "table", lambda timed: steps(*complete))
    monkeypatch.setattr(table_1, "errors", lambda near: errors(*off))
    assert word("w1", None, None) == expected
    assert word("w1", None, None, None) == expected  # one view more, of the same times and errors


@pytest.mark.parametrize(("warped", "distances", "expected"), [
    (0.9, (0.12, 0.10, 0.08, 0.072, 0.071, 0.07, 0.07, 0.07), HOLDS),
    (0.9, (0.12, 0.11, 0.10, 0.09, 0.09, 0.08, 0.07, 0.06), IN_PART),
    (0.2, (0.12, 0.11, 0.10, 0.09, 0.09, 0.08, 0.07, 0.06), DOES_NOT_HOLD),
])  # fmt: skip
def test_clusters_must_converge_and_seeds_move(warped, distances, expected, monkeypatch):
    share, found = moved(warped, *distances)
    monkeypatch.setattr(figure_3, "specular", lambda records: share)
    monkeypatch.setattr(figure_3, "convergence", lambda records: found)
    assert word("w6", None) == expected


RISING, FLAT = [10, 12, 15, 20, 30, 50, 90], [10] * 7
CASES = [
    ("w2", figure_7, points(0.1, 0.0), HOLDS, 3),
    ("w2", figure_7, points(0.1, 0.01), IN_PART, 3),
    ("w2", figure_7, points(0.3, 0.02), DOES_NOT_HOLD, 3),
    ("w3", figure_8, looked_up((0.1, 0.02), (0.05, 0.005)), HOLDS, 1),
    ("w3", figure_8, looked_up((0.1, 0.02), (0.2, 0.005)), IN_PART, 1),
    ("w3", figure_8, looked_up((0.1, 0.02), (0.2, 0.02)), DOES_NOT_HOLD, 1),
    ("w4", figure_9, times(RISING, [2 * one for one in RISING]), HOLDS, 1),
    ("w4", figure_9, times(FLAT, [5] * 7), DOES_NOT_HOLD, 1),
    ("w5", figure_4, holes((0.3, 0.0, 0.4), (0.01, 0.3, 0.1)), HOLDS, 1),
    ("w5", figure_4, holes((0.3, 0.0, 0.4), (0.01, 0.9, 0.0)), IN_PART, 1),
    ("w5", figure_4, holes((0.3, 0.0, 0.4), (0.2, 0.9, 0.1)), DOES_NOT_HOLD, 1),
    ("w7", figure_1, corner(5.0, 1.0, 0.9), HOLDS, 1),
    ("w7", figure_1, corner(5.0, 1.0, 1.0), IN_PART, 1),
    ("w7", figure_1, corner(1.0, 2.0, 1.0), DOES_NOT_HOLD, 1),
]


@pytest.mark.parametrize(("name", "module", "table", "expected", "studies"), CASES)
def test_a_claim_about_area_lights_is_judged_by_its_table(name, module, table, expected, studies, monkeypatch):
    monkeypatch.setattr(module, "table", lambda *records: table)
    assert word(name, *[None] * studies) == expected


def test_equal_time_is_the_most_points_that_take_no_longer():
    assert figure_7.at_equal_time(points(0.1, 0.0)) == "512 points"
