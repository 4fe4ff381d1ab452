"""Break points of errors whose crossing is known."""

import math

import numpy as np
import pytest

import interreflect as ir
from interreflect.stability.crossing import ALWAYS, BREAKS, NEVER, REVERSED, find, point_of
from interreflect.stability.failure import Failure, Reading

BLANK = np.zeros((2, 2, 3), np.float32)


def row(**changes):
    keys = {
        "name": "test", "knob": "k", "unit": "", "easy": 1.0, "hard": 1000.0, "scene": lambda value: ir.Scene(),
        "measure": lambda trial: None,         "quantity": "q", "truth": "t", "tolerance": 0.01, "reason": "r", "stages": (),
    }  # fmt: skip
    return Failure(**(keys | changes))


def at(law, noise=0.0, seeds=3, floor=0.0):
    """A measure of readings whose mean follows `law`, each off by up to `noise` of it, the same for equal values."""

    def measure(value):
        rng = np.random.default_rng(int(value * 1e6) % 2**32)
        errors = law(value) * (1 + noise * rng.standard_normal(seeds))
        return point_of(value, [Reading(float(abs(error)), BLANK, floor=floor) for error in errors])

    return measure


@pytest.mark.parametrize("place", [1.7, 30.0, 700.0])
@pytest.mark.parametrize("downward", [False, True])
def test_a_known_crossing_is_found_within_its_interval(place, downward):
    # An error that grows with the square of the knob; or, with the hard end below the easy one, against it.
    failure = row(easy=1000.0, hard=1.0) if downward else row()
    law = (lambda v: 0.01 * (place / v) ** 2) if downward else (lambda v: 0.01 * (v / place) ** 2)
    crossing = find(failure, at(law))
    # Six values over three decades, halved four times: brackets of a factor 1000^(1/5/16) = 1.09.
    assert crossing.outcome == BREAKS and crossing.value == pytest.approx(place, rel=0.05)
    assert crossing.low <= place <= crossing.high and crossing.high / crossing.low < 1.1
    safe, broken = (crossing.after, crossing.before) if downward else (crossing.before, crossing.after)
    assert safe.value <= place <= broken.value
    assert crossing.before.error < 0.01 < crossing.after.error


def test_on_an_even_scale_the_sweep_may_start_at_0():
    crossing = find(row(easy=0.0, hard=1.0, logarithmic=False), at(lambda v: 0.03 * v))
    assert crossing.value == pytest.approx(1 / 3, rel=0.01)


def test_noise_and_the_truths_own_noise_widen_the_interval():
    law = lambda v: 0.01 * v / 30  # noqa: E731
    sharp, noisy, unsure = (find(row(), at(law, noise, floor=floor)) for noise, floor in ((0, 0), (0.2, 0), (0, 0.004)))
    assert sharp.high / sharp.low < 1.1
    for crossing in (noisy, unsure):
        assert crossing.low < sharp.low and crossing.high > sharp.high
        assert crossing.low < 30 < crossing.high
    # Errors within .004 of the tolerance decide nothing: values from 18 to 42 stay open.
    assert unsure.low <= 18 and unsure.high >= 42


def test_a_95_per_cent_interval_holds_the_crossing_in_about_as_many_runs():
    held = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)

        def measure(value, rng=rng):
            return point_of(value, [Reading(0.01 * value / 30 * (1 + 0.1 * rng.standard_normal()), BLANK) for _ in range(3)])

        crossing = find(row(), measure)
        held += crossing.low <= 30 <= crossing.high
    assert held >= 32  # 38 expected; 32 or fewer of 40 at 95 % happens once in a thousand


def test_errors_that_do_not_cross_are_told_in_words():
    never, always = find(row(), at(lambda v: 0.001)), find(row(), at(lambda v: 1.0))
    assert (never.outcome, always.outcome) == (NEVER, ALWAYS)
    assert (never.words, always.words) == ("never crosses", "always above")
    assert math.isnan(never.value) and never.before is None
    assert "noise reaches" in find(row(), at(lambda v: 0.009, floor=0.005)).words
    assert "within noise" in find(row(), at(lambda v: 0.011, floor=0.005)).words


def test_an_error_that_falls_along_the_sweep_is_reversed():
    crossing = find(row(), at(lambda v: 0.01 * (30 / v)))
    assert crossing.outcome == REVERSED and crossing.low <= 30 <= crossing.high
    assert crossing.words == "above at the easy end, below from there on"
    assert crossing.before.error > 0.01 > crossing.after.error


def test_an_error_that_crosses_more_than_once_says_so():
    crossing = find(row(), at(lambda v: 0.02 if 10 < v < 20 or v > 200 else 0.001))
    assert crossing.outcome == BREAKS and crossing.value == pytest.approx(10, rel=0.1) and "crosses 3 times" in crossing.words


def test_pictures_that_are_not_finite_are_beyond_every_tolerance():
    crossing = find(row(), at(lambda v: math.inf if v > 50 else 0.001))
    assert crossing.outcome == BREAKS and crossing.low <= 50 <= crossing.high
