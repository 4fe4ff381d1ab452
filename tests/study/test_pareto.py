"""Rankings of records whose times and errors are given."""

import math
from pathlib import Path

import pytest

from interreflect.study.pareto import best, cheapest, configurations, equal_error, equal_time, hypervolume, pareto
from interreflect.study.records import Record, Records

# moocore's own example of a front, in (milliseconds, relmse); (16, .25) and (20, .5) are dominated
POINTS = [(2, 0.5), (5, 0.2), (16, 0.1), (20, 0.05), (16, 0.25), (20, 0.5)]


def record(milliseconds, relmse, method="fake", scene="room", seed=0, noise=1e-6, status="ok", **changes):
    values = {
        "key": f"{method}{scene}{milliseconds}{relmse}{seed}",
        "scene": scene,
        "scene_hash": scene,
        "camera": "front",
        "camera_values": {},
        "method": method,
        "knobs": {"time": milliseconds, "error": round(relmse, 3)},
        "seed": seed,
        "size": (4, 4),
        "bounces": 1,
        "threads": 1,
        "machine": {},
        "milliseconds": milliseconds,
        "noise": noise,
        "indirect_noise": noise,
        "status": status,
        "metrics": {"relmse": relmse, "ssim": 1 - relmse},
    }
    return Record(**values | changes)


def records(*items):
    return Records("given", tuple(items), Path())


def front(table):
    return list(table[["milliseconds", "relmse"]].itertuples(index=False, name=None))


def test_the_front_is_the_non_dominated_configurations_fastest_first():
    assert front(pareto(records(*(record(*p) for p in reversed(POINTS))))) == POINTS[:4]


def test_equal_configurations_are_all_on_the_front():
    twins = records(record(2, 0.5, "a"), record(2, 0.5, "b"), record(3, 0.6, "c"))
    assert sorted(pareto(twins)["method"]) == ["a", "b"]


def test_fronts_are_per_scene_camera_and_bounces():
    slower = [
        record(9, 0.9, scene="hall"),
        record(9, 0.9, camera="side"),
        record(9, 0.9, bounces=None),
        record(9, 0.9, bounces=2),
    ]
    table = pareto(records(record(1, 0.1), *slower))
    assert len(table) == 5
    assert set(table["bounces"]) == {1, 2, "all"}


def test_a_front_in_ssim_prefers_larger_values():
    table = pareto(records(record(1, 0.5), record(2, 0.1), record(3, 0.3)), y="ssim")
    assert list(table["milliseconds"]) == [1, 2]


def test_seeds_of_a_configuration_are_one_point():
    seeds = [record(t, e, knobs={"spp": 1}, seed=s) for s, (t, e) in enumerate([(1, 0.1), (2, 0.2), (9, 0.6)])]
    (row,) = configurations(records(*seeds)).to_dict("records")
    assert (row["milliseconds"], row["seeds"]) == (2, 3)  # median of times
    assert row["relmse"] == pytest.approx(0.3)  # mean of errors


@pytest.mark.parametrize("status", ["failed", "not finite"])
def test_a_configuration_of_which_a_seed_failed_is_not_ranked(status):
    seeds = [
        record(1, 0.1, knobs={"spp": 1}),
        record(math.nan, math.nan, knobs={"spp": 1}, seed=1, status=status),
        record(5, 0.5),
    ]
    assert front(pareto(records(*seeds))) == [(5, 0.5)]


def test_the_cheapest_keeps_within_the_bound():
    assert front(cheapest(records(*(record(*p) for p in POINTS)), relmse=0.2)) == [(5, 0.2)]
    assert front(cheapest(records(*(record(*p) for p in POINTS)), ssim=0.85)) == [(16, 0.1)]
    assert cheapest(records(*(record(*p) for p in POINTS)), relmse=0.01).empty


def test_the_best_keeps_within_the_budget():
    assert front(best(records(*(record(*p) for p in POINTS)), milliseconds=16)) == [(16, 0.1)]
    assert best(records(*(record(*p) for p in POINTS)), milliseconds=1).empty


def test_equal_time_ranks_every_methods_most_accurate_within_the_budget():
    table = equal_time(records(record(5, 0.3, "a"), record(9, 0.2, "a"), record(8, 0.1, "b"), record(50, 0.01, "b")), milliseconds=10)
    assert list(table[["method", "milliseconds", "relmse"]].itertuples(index=False, name=None)) == [("b", 8, 0.1), ("a", 9, 0.2)]


def test_equal_error_ranks_every_methods_fastest_within_the_bound():
    table = equal_error(records(record(5, 0.3, "a"), record(9, 0.2, "a"), record(8, 0.1, "b"), record(50, 0.01, "b")), relmse=0.2)
    assert list(table[["method", "milliseconds"]].itertuples(index=False, name=None)) == [("b", 8), ("a", 9)]


def test_the_hypervolume_is_the_area_below_the_reference_point():
    # decades below (10^4 ms, 1): (1, .1) dominates 4 x 1, (100, .001) adds 2 x 2
    table = hypervolume(records(record(1, 0.1), record(100, 0.001), record(1000, 0.01), record(5, 2.0, "b")))
    assert dict(zip(table["method"], table["hypervolume"], strict=True)) == pytest.approx({"fake": 8.0, "b": 0.0})


def test_errors_below_the_truths_noise_are_not_ranked():
    table = pareto(records(record(1, 0.5, noise=0.01), record(2, 0.1, noise=0.01), record(3, 0.009, noise=0.01)))
    assert list(table["note"]) == ["", "", "within noise"]


def test_gains_below_the_truths_noise_are_not_ranked():
    table = pareto(records(record(1, 0.5, noise=0.01), record(2, 0.495, noise=0.01), record(3, 0.4, noise=0.01)))
    assert list(table["note"]) == ["", "within noise", ""]


def test_a_winner_by_less_than_the_noise_says_so():
    close = records(record(5, 0.3, "a", noise=0.01), record(6, 0.295, "b", noise=0.01))
    assert list(best(close, milliseconds=10)["note"]) == ["within noise"]
    assert list(equal_time(close, milliseconds=10)["note"]) == ["within noise", ""]
    apart = records(record(5, 0.3, "a", noise=0.01), record(6, 0.2, "b", noise=0.01))
    assert list(best(apart, milliseconds=10)["note"]) == [""]


def test_a_bound_closer_than_the_noise_says_so():
    assert list(cheapest(records(record(5, 0.1, noise=0.01)), relmse=0.105)["note"]) == ["within noise"]
    assert list(cheapest(records(record(5, 0.1, noise=0.01)), relmse=0.2)["note"]) == [""]


@pytest.mark.parametrize("bound", [{}, {"relmse": 0.1, "flip": 0.1}, {"speed": 3}])
def test_a_bound_is_one_error(bound):
    with pytest.raises(TypeError, match="takes one bound, one of relmse"):
        cheapest(records(record(1, 1)), **bound)


def test_columns_that_do_not_rank_are_value_errors():
    with pytest.raises(ValueError, match="got 'seed'"):
        pareto(records(record(1, 1)), x="seed")


def test_no_records_make_empty_rankings():
    for table in (
        pareto(records()),
        best(records(), milliseconds=1),
        cheapest(records(), relmse=1),
        equal_time(records(), milliseconds=1),
    ):
        assert table.empty
        assert "note" in table.columns
