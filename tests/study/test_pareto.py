"""Rankings of records whose times and errors are given."""

import dataclasses
import math
import warnings
from pathlib import Path

import numpy as np
import pytest

from interreflect.study.configurations import configurations
from interreflect.study.pareto import best, cheapest, equal_error, equal_time, hypervolume, inefficiency, knee, pareto
from interreflect.study.records import Record, Records
from interreflect.study.uncertainty import mean_interval

# moocore's own example of a front, in (milliseconds, relmse); (16, .25) and (20, .5) are dominated
POINTS = [(2, 0.5), (5, 0.2), (16, 0.1), (20, 0.05), (16, 0.25), (20, 0.5)]


def record(milliseconds, relmse, method="fake", scene="room", seed=0, noise=0.0, status="ok", **changes):
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
    assert list(cheapest(records(record(5, 0.1, noise=0.01)), relmse=0.095)["note"]) == ["within noise"]
    assert list(cheapest(records(record(5, 0.1, noise=0.01)), relmse=0.2)["note"]) == [""]


def test_several_bounds_hold_at_once():
    rooms = records(record(5, 0.1, metrics={"relmse": 0.1, "flip": 0.3}), record(9, 0.2, metrics={"relmse": 0.2, "flip": 0.1}))
    assert list(cheapest(rooms, relmse=0.2, flip=0.2)["milliseconds"]) == [9]
    assert list(equal_error(rooms, relmse=0.2, flip=0.4)["milliseconds"]) == [5]
    assert cheapest(rooms, relmse=0.1, flip=0.1).empty


@pytest.mark.parametrize("bound", [{}, {"speed": 3}])
def test_a_bound_is_an_error(bound):
    with pytest.raises(TypeError, match="takes bounds of relmse"):
        cheapest(records(record(1, 1)), **bound)


def test_the_truths_noise_is_subtracted_and_reported():
    (row,) = configurations(records(record(1, 0.5, noise=0.1))).to_dict("records")
    assert (row["relmse"], row["noise"]) == (0.4, 0.1)
    assert cheapest(records(record(1, 0.5, noise=0.02)), relmse=0.49).shape[0] == 1


def test_intervals_on_both_axes_come_from_seeds_and_repeats():
    seeds = [record(t, e, knobs={}, seed=s, times=(t, t)) for s, (t, e) in enumerate([(1, 0.1), (2, 0.2), (9, 0.6)])]
    (row,) = configurations(records(*seeds)).to_dict("records")
    reach = 4.302652729696142 * np.std([0.1, 0.2, 0.6], ddof=1) / math.sqrt(3)  # Student's t, two degrees of freedom, 97.5 %
    assert (row["relmse_low"], row["relmse_high"]) == pytest.approx((0.3 - reach, 0.3 + reach))
    assert (row["milliseconds_low"], row["milliseconds_high"]) == (1, 9)  # six times: smallest and largest hold the median in 97 %
    (row,) = configurations(records(*(dataclasses.replace(seed, times=()) for seed in seeds))).to_dict("records")
    assert math.isnan(row["milliseconds_low"])  # three times say less than 95 %


def test_a_gain_within_the_intervals_is_not_ranked():
    rough = [record(1, e, knobs={"spp": 1}, seed=s) for s, e in enumerate([0.4, 0.6, 0.5])]
    finer = [record(2, e, knobs={"spp": 2}, seed=s) for s, e in enumerate([0.3, 0.6, 0.45])]
    best_of_all = [record(3, e, knobs={"spp": 3}, seed=s) for s, e in enumerate([0.010, 0.012, 0.011])]
    assert list(pareto(records(*rough, *finer, *best_of_all))["note"]) == ["", "within noise", ""]


def test_work_bytes_and_memory_are_axes_of_their_own():
    def working(milliseconds, error, rays, size):
        stages = {
            "march": {"milliseconds": 1.0, "bytes": size, "counts": {"rays": rays, "steps": 1}},
            "shade": {"milliseconds": 1.0, "bytes": 1, "counts": {"rays": 5}},
        }
        return record(milliseconds, error, stages=stages)

    both = records(working(1, 0.5, 100, 10), working(2, 0.1, 10, 20))
    assert list(pareto(both, x="work.rays")["work.rays"]) == [15]  # fewer rays and less error
    assert list(pareto(both, x="bytes")["bytes"]) == [11, 21]
    with pytest.raises(ValueError, match=r"work\.rays, work\.steps"):
        pareto(both, x="work.cones")


def test_the_knee_is_where_a_front_bends_most():
    bent = records(record(1, 1.0), record(10, 0.01), record(30, 0.008), record(100, 0.005))
    assert front(knee(bent)) == [(10, 0.01)]
    straight = records(record(1, 1.0), record(10, 0.1), record(100, 0.01), record(10000, 1e-4, scene="hall"))
    assert knee(straight).empty
    bulging = records(record(1, 1.0), record(10, 0.5), record(100, 0.01))
    assert knee(bulging).empty


def test_inefficiency_is_error_times_time_least_first():
    table = inefficiency(records(record(1, 0.5), record(2, 0.1), record(100, 0.01)))
    assert list(table["inefficiency"]) == pytest.approx([0.2, 0.5, 1.0])
    seeds = [record(2, e, knobs={}, seed=s) for s, e in enumerate([0.1, 0.12, 0.11])]
    (row,) = inefficiency(records(*seeds)).to_dict("records")
    assert row["inefficiency_low"] < 0.22 < row["inefficiency_high"]
    assert row["relmse_low"] * 2 == pytest.approx(row["inefficiency_low"], rel=0.1)


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


def test_intervals_are_those_of_each_configuration_whatever_its_number_of_seeds():
    errors = {1.0: [0.5], 2.0: [0.3, 0.2, 0.4], 3.0: [0.1, 0.2], 4.0: list(np.linspace(0.1, 0.4, 12)), 5.0: [0.25, 0.35, 0.3]}
    order = np.random.default_rng(4).permutation([(time, k) for time, given in errors.items() for k in range(len(given))])
    given = [record(time, errors[time][int(k)], seed=int(k), knobs={"time": time}) for time, k in order]
    for _, row in configurations(records(*given)).iterrows():
        seeds = [item.metrics["relmse"] for item in given if item.milliseconds == row["milliseconds"]]
        assert row["seeds"] == len(seeds)
        assert (row["relmse_low"], row["relmse_high"]) == pytest.approx(mean_interval(seeds), rel=1e-12, nan_ok=True)


def test_a_hundred_columns_of_work_warn_of_nothing():
    stages = {f"stage{k}": {"milliseconds": 1.0, "bytes": k, "counts": {f"work{k}": k}} for k in range(60)}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(pareto(records(record(1, 0.5, stages=stages), record(2, 0.3, stages=stages, knobs={"spp": 2})))) == 2
