"""Marginals of a method whose next steps are known, and advice on a real scene."""

import pytest
from search_fakes import Tunable
from study_fakes import Scene

import interreflect as ir
from interreflect.study.marginal import marginal
from interreflect.study.reference import Reference


def error_of(effort):
    """relMSE of the first three seeds: a quarter of the light is 4 e too bright, e = 1/effort and .01 of it more a seed."""
    return sum((1.01 - 0.01 + 0.01 * seed) ** 2 for seed in range(3)) / 3 / effort**2


def test_a_step_is_worth_the_error_it_loses_over_the_time_it_adds(fake_truth, tmp_path):
    found = marginal(Tunable(), Scene(), size=(100, 100), reference=Reference(1e-6, 65536), folder=tmp_path / "a")
    rows = {(row["knob"], row["to"]): row for _, row in found.table.iterrows()}
    more = rows["effort", 15.0]
    assert found.error == pytest.approx(error_of(10), rel=0.03)
    assert more["error"] == pytest.approx(error_of(15) - error_of(10), rel=0.05)
    assert more["milliseconds"] == pytest.approx(5.0)
    assert more["error_per_millisecond"] == pytest.approx((error_of(10) - error_of(15)) / 5, rel=0.05)
    assert more["note"] == "" and more["low"] < more["error"] < more["high"] < 0
    less = rows["waste", 5.0 / 1.5]
    assert less["note"] == "within noise" and less["milliseconds"] == pytest.approx(-5 / 3)
    assert rows["flag", True]["error"] < 0


def test_advice_names_what_to_use_what_to_drop_and_what_it_rests_on(tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    from interreflect.study.ladder import mechanisms

    given = {"size": (36, 27), "reference": Reference(5e-3, 256), "folder": tmp_path / "a"}
    given["rungs"] = mechanisms()[:2]  # the others take the same way, and longer
    advice = ir.advise(ir.scenes.cornell_box(), **given)
    assert "constant-ambient" in advice.text.splitlines()[0]
    assert "Stages of constant-ambient whose exact counterpart changes nothing here: sky" in advice.text  # a box has none
    assert "of the attribution" in advice.text and str(tmp_path) in advice.text
    assert repr(advice) == advice.text
    slow = ir.advise(ir.scenes.cornell_box(), milliseconds=1e-6, **given)
    assert "which nothing meets" in slow.text
