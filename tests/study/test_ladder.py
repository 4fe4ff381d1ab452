"""The ladder: climbs over methods whose error is known, and over a real scene's mechanisms."""

import numpy as np
import pytest
from study_fakes import Fake, Scene

import interreflect as ir
from interreflect.study.ladder import WITHIN_NOISE, Mechanism, ladder, mechanisms
from interreflect.study.reference import Reference

GOOD = Reference(noise=1e-5, max_spp=8192)


def error(factor):
    """relMSE of indirect light, a quarter of the whole, times 1 + factor (and .01 of it more a seed): but for epsilon, (factor / 4)^2."""
    return float(np.mean([(factor * (1 + 0.01 * seed) / 4) ** 2 for seed in range(3)]))


@pytest.fixture
def climb(fake_truth, tmp_path):
    return lambda *rungs: ladder(Scene(), size=(24, 16), rungs=rungs, reference=GOOD, folder=tmp_path / "ladder")


def test_rungs_hold_error_gain_and_time_and_those_without_a_gain_are_not_needed(climb):
    found = climb(
        Mechanism("first", [Fake(error=0.8, time=1.0), Fake(error=0.4, time=2.0), Fake(error=0.4001, time=4.0)]),
        Mechanism("worse", [Fake(error=0.6, time=3.0)]),
        Mechanism("same", [Fake(error=0.3999, time=3.0)]),
        Mechanism("better", [Fake(error=0.2, time=5.0)]),
    )
    assert [(rung.mechanism, rung.needed, rung.note) for rung in found.rungs] == [
        ("first", True, ""),
        ("worse", False, ""),
        ("same", False, WITHIN_NOISE),
        ("better", True, ""),
    ]
    first, worse, _, better = found.rungs
    assert first.method == Fake(error=0.4, time=2.0)  # more samples than this gained nothing
    assert len(first.settings) == 3
    assert better.error == pytest.approx(error(0.2), rel=0.03)
    assert better.gain == pytest.approx(error(0.4) - error(0.2), rel=0.03)
    assert worse.gain == pytest.approx(error(0.4) - error(0.6), rel=0.03)
    assert better.gain_low < better.gain < better.gain_high
    assert better.extra_milliseconds == 3.0  # beyond the highest needed rung below
    assert [rung.mechanism for rung in found.needed] == ["first", "better"]
    assert "better" in repr(found) and len(found.table) == 4


def test_the_climb_ends_where_what_is_left_is_noise(climb):
    found = climb(
        Mechanism("first", [Fake(error=0.4)]), Mechanism("all but exact", [Fake(error=0.001)]), Mechanism("never", [Fake(mode="raises")])
    )
    assert [rung.mechanism for rung in found.rungs] == ["first", "all but exact"]
    assert "within the truth's own noise" in found.stopped


def test_the_climb_ends_where_exact_light_has_nothing_more_to_give(climb):
    # The fake scene's light is the same for any number of bounces, so exact direct light leaves no error.
    found = climb(Mechanism("direct", [Fake(error=0.4)], bounces=0), Mechanism("never", [Fake(mode="raises")]))
    assert len(found.rungs) == 1
    assert found.rungs[0].exact_error == pytest.approx(0, abs=1e-6)
    assert found.stopped.startswith("stopped: beyond direct exact light gains")


def test_a_mechanism_that_cannot_be_measured_says_why(climb):
    with pytest.raises(ValueError, match="broken: no setting could be measured: RuntimeError: lamp broken"):
        climb(Mechanism("broken", [Fake(mode="raises")]))


def test_a_real_scene_with_all_but_black_walls_needs_direct_light_only(tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    # an odd size: no pixel looks exactly at an edge between two walls, where either is right
    dim = ir.scenes.cornell_box(light="point").replace(materials={"*": {"albedo": (0.001, 0.001, 0.001)}})
    found = ladder(dim, size=(35, 23), rungs=mechanisms()[:2], reference=Reference(1e-3, 2), folder=tmp_path / "a")
    assert [rung.mechanism for rung in found.rungs] == ["direct light"]


def test_the_chart_shows_every_rung(climb):
    figure = climb(Mechanism("first", [Fake(error=0.4), Fake(error=0.3)], bounces=0)).chart()
    assert [text.get_text() for text in figure.axes[1].get_xticklabels()] == ["first"]
