"""Timing of renders whose times are given."""

import gc
import itertools
import math
import os
import subprocess
import sys
import time

import numpy as np
import pytest
from study_fakes import frame

import interreflect.study.contention as contention_module
import interreflect.study.timing as timing
from interreflect.study.contention import TOLERATED_SHARE, Contention, Watch
from interreflect.study.timing import measure, settled, summary
from interreflect.study.uncertainty import median_interval

LIGHT = np.zeros((2, 2, 3), np.float32)


def study_frame(milliseconds):
    return frame(LIGHT, LIGHT, milliseconds)


@pytest.fixture(autouse=True)
def quiet(monkeypatch):
    """No contention unless a test says so."""
    monkeypatch.setattr(timing, "Watch", Quiet)


class Quiet(Watch):
    def contention(self):
        return Contention(0.0, False)


def timed(milliseconds, repeats, max_repeats):
    """The timing of renders that take these times; the first is the warm-up."""
    times = itertools.chain(milliseconds, itertools.repeat(milliseconds[-1]))
    return measure(lambda: frame(LIGHT, LIGHT, next(times)), repeats, max_repeats)[1]


def test_the_warm_up_does_not_count():
    assert timed([1000.0, 5.0], 3, 3).milliseconds == 5.0


@pytest.mark.parametrize(("repeats", "expected"), [(1, 6), (4, 6), (9, 9)])
def test_steady_times_end_as_soon_as_an_interval_exists_and_the_repeats_are_made(repeats, expected):
    assert timed([9.0, 5.0], repeats, 30).repeats == expected


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


def test_every_repeat_is_kept():
    assert timed([9.0, 5.0, 6.0, 7.0], 3, 3).times == (5.0, 6.0, 7.0)


@pytest.mark.parametrize("count", [6, 13, 30])
def test_the_interval_holds_the_median_of_all_times_in_95_of_100_cases_however_skewed(count):
    random, studies = np.random.default_rng(5), 4000
    held = sum(low <= np.exp(0) <= high for low, high in (median_interval(random.lognormal(0, 1, count)) for _ in range(studies)))
    # at least 95 %, up to 4 standard errors of the count; the steps of the binomial leave up to 3 % more
    assert 0.95 - 4 * math.sqrt(0.95 * 0.05 / studies) <= held / studies <= 0.98


def test_fewer_than_six_times_have_no_interval():
    assert all(math.isnan(end) for end in median_interval([1.0] * 5))
    assert median_interval([3.0, 1.0, 2.0, 6.0, 5.0, 4.0]) == (1.0, 6.0)


def test_settled_means_both_ends_within_two_per_cent_of_the_median():
    assert settled([0.981, *[1.0] * 4, 1.019])
    assert not settled([0.979, *[1.0] * 4, 1.0])
    assert not settled([1.0] * 5)


def test_without_repeats_nothing_is_timed_but_the_work_is_known():
    _, result = measure(lambda: study_frame(5.0), 0, 30)
    assert result.repeats == 0 and result.times == () and math.isnan(result.milliseconds)
    assert math.isnan(result.stages["march"]["milliseconds"]) and result.stages["march"]["counts"] == {"rays": 10}


def contended(monkeypatch, shares):
    """The timing and the number of renders where others take these shares, one in each round of repeats."""
    others, renders = iter(shares), []

    class Given(Watch):
        def contention(self):
            share = next(others)
            return Contention(share, share > TOLERATED_SHARE)

    def render():
        renders.append(None)
        return study_frame(float(len(renders)))

    monkeypatch.setattr(timing, "Watch", Given)
    return measure(render, 3, 3)[1], len(renders)


def test_contended_times_are_taken_again(monkeypatch):
    result, renders = contended(monkeypatch, [0.5, 0.0])
    assert (result.contended, result.others_share, result.times, renders) == (False, 0.0, (5.0, 6.0, 7.0), 7)


def test_times_that_are_contended_twice_are_marked_and_the_quieter_ones_kept(monkeypatch):
    result, _ = contended(monkeypatch, [0.3, 0.5])
    assert (result.contended, result.others_share, result.times) == (True, 0.3, (2.0, 3.0, 4.0))


def spin(seconds):
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        pass


def test_the_share_that_others_take_is_measured():
    """Another process on every processor, 0.4 s: it takes at least half of what this process does not get."""
    busy = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in os.sched_getaffinity(0)]
    try:
        time.sleep(0.2)  # until they run
        watch = Watch()
        spin(0.4)
        found = watch.contention()
    finally:
        for process in busy:
            process.kill()
            process.wait()
    assert found.contended
    assert found.others_share > 0.5 * (1 - 1 / len(busy))  # alone, this process would fill one processor of them


def test_own_work_is_not_that_of_others():
    """All of this process's threads' work in the counts of the system is its own; nobody can say what others do meanwhile."""
    _, busy, own, _ = contention_module._reading()
    spin(0.5)
    later = contention_module._reading()
    # its own half second, less what the clock's ticks lose
    assert later[2] - own <= later[1] - busy + 2 * contention_module.TICK * len(os.sched_getaffinity(0))


def test_stages_have_the_median_of_their_times():
    stages = summary([frame(LIGHT, LIGHT, t).profile for t in (1.0, 2.0, 10.0)], Watch()).stages
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
