"""Timing of renders whose times are given."""

import gc
import itertools

import numpy as np
import pytest
from study_fakes import frame

from interreflect.study.timing import MEDIAN_FROM_MEAN, NORMAL_FROM_MAD, SETTLED, measure, settled, summary

LIGHT = np.zeros((2, 2, 3), np.float32)


def timed(milliseconds, repeats, max_repeats):
    """The timing of renders that take these times; the first is the warm-up."""
    times = itertools.chain(milliseconds, itertools.repeat(milliseconds[-1]))
    return measure(lambda: frame(LIGHT, LIGHT, next(times)), repeats, max_repeats)[1]


def test_the_warm_up_does_not_count():
    assert timed([1000.0, 5.0], 3, 3).milliseconds == 5.0


def test_steady_times_end_after_the_repeats():
    assert timed([9.0, 5.0], 4, 30).repeats == 4


def test_unsteady_times_go_on_to_the_largest_number():
    times = np.random.default_rng(3).uniform(1, 10, 40).tolist()
    assert timed(times, 3, 12).repeats == 12


def test_repeats_end_as_soon_as_the_median_is_known():
    # three repeats that differ, then steady ones: the deviation from the median shrinks to 0
    assert 3 < timed([1.0, 10.0, 5.0, 20.0, 10.0], 3, 100).repeats < 100


def test_one_slow_repeat_does_not_move_the_median():
    assert timed([1.0, 5.0, 5.0, 500.0, 5.0], 5, 5).milliseconds == 5.0


def test_the_95th_percentile_is_that_of_the_repeats():
    assert timed([1.0, *map(float, range(1, 102))], 101, 101).milliseconds_p95 == pytest.approx(96.0)


def test_the_median_of_normal_times_is_known_as_well_as_is_said():
    random, n, deviation = np.random.default_rng(5), 64, 0.05
    medians = [np.median(random.normal(1, deviation, n)) for _ in range(4000)]
    # for a normal distribution the rule's standard error is the true one; asymptotic in n, hence 5 %
    assert np.std(medians) == pytest.approx(MEDIAN_FROM_MEAN * deviation / np.sqrt(n), rel=0.05)
    mad = np.median(np.abs(random.normal(0, 1, 100_000)))
    assert mad * NORMAL_FROM_MAD == pytest.approx(1, rel=0.02)  # 4 standard errors of 1e5 samples: 1.5 %


def test_settled_means_two_per_cent_of_the_median():
    at_bound = SETTLED / (MEDIAN_FROM_MEAN * NORMAL_FROM_MAD)  # deviation of one repeat at which n = 1 would settle
    spread = lambda share: [1 - share, 1.0, 1 + share]  # noqa: E731
    assert settled(spread(0.99 * at_bound * np.sqrt(3)))
    assert not settled(spread(1.01 * at_bound * np.sqrt(3)))


def test_stages_have_the_median_of_their_times():
    stages = summary([frame(LIGHT, LIGHT, t).profile for t in (1.0, 2.0, 10.0)]).stages
    assert stages["march"] == {"milliseconds": 1.5, "bytes": 64, "counts": {"rays": 10}}


def test_garbage_collection_waits_while_times_are_taken_and_goes_on_afterwards():
    seen = []
    measure(lambda: seen.append(gc.isenabled()) or frame(LIGHT, LIGHT), 2, 2)
    assert seen == [True, False, False]  # the warm-up, then the timed ones
    assert gc.isenabled()
    with pytest.raises(ZeroDivisionError):
        timed_out = itertools.count()
        measure(lambda: frame(LIGHT, LIGHT, 1 / (1 - next(timed_out))), 2, 2)
    assert gc.isenabled()
