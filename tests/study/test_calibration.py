"""What a machine can do, and times as multiples of it."""

import dataclasses
import json
import math

import pytest
from study_fakes import Fake, Scene

from interreflect.machine import about
from interreflect.study.calibration import Calibration, calibrate
from interreflect.study.run import run
from interreflect.study.store import load_records
from interreflect.study.study import Study

SLOW = Calibration(
    read=20, triad=25, multiply_add=100, coherent_rays=10, incoherent_rays=2, occlusion_rays=4, vector_bytes=32, threads=2, processor="slow"
)
RATES = ("read", "triad", "multiply_add", "coherent_rays", "incoherent_rays", "occlusion_rays")


def stage(milliseconds, result_bytes=0, **counts):
    return {"milliseconds": milliseconds, "bytes": result_bytes, "counts": counts}


def test_this_machine_has_rates():
    found = calibrate(None)
    assert all(getattr(found, name) > 0 for name in RATES)
    assert found.coherent_rays > found.incoherent_rays  # rays side by side share their way through the hierarchy
    assert 8 * found.vector_bytes == about().vector_bits


def test_a_limit_is_the_work_over_the_rates():
    stages = {"gbuffer": stage(1, rays=1_000_000), "march": stage(1, cone_steps=1_000_000), "voxelize": stage(1, 25_000_000)}
    # a million rays at 10 M/s; 136 operations each at 100 GFLOP/s; 25 MB at 25 GB/s
    assert SLOW.limit_milliseconds(stages) == pytest.approx(100 + 1.36 + 1.0)


def test_what_counts_no_work_has_no_limit():
    assert math.isnan(SLOW.limit_milliseconds({"sky": stage(1)}))


def test_a_machine_twice_as_fast_in_all_and_in_time_has_the_same_ratio():
    fast = dataclasses.replace(SLOW, **{name: 2 * getattr(SLOW, name) for name in RATES})
    stages = {"gbuffer": stage(1, 10**6, rays=123_456), "march": stage(1, cone_steps=3_456_789)}
    assert 30.0 / SLOW.limit_milliseconds(stages) == pytest.approx(15.0 / fast.limit_milliseconds(stages))


def test_every_timed_record_names_a_calibration_that_lies_in_the_folder(tmp_path, fake_truth):
    study = Study(name="c", scenes=[Scene()], methods=[Fake(), Fake(mode="crashes"), Fake(error=0.3)], size=(32, 24), repeats=1)
    run(study, tmp_path / "r")
    records = load_records(tmp_path / "r")
    assert records[0].calibration == records[2].calibration  # once a study, though a worker was lost
    assert records.calibrations[records[0].calibration].processor == about().processor
    row = records.table.iloc[0]
    assert row["limit_milliseconds"] == pytest.approx(records.calibrations[records[0].calibration].limit_milliseconds(records[0].stages))
    assert row["limit_ratio"] == pytest.approx(row["milliseconds"] / row["limit_milliseconds"])


def test_a_damaged_calibration_costs_only_the_ratio(tmp_path, fake_truth):
    run(Study(name="c", scenes=[Scene()], methods=[Fake()], size=(32, 24), repeats=1), tmp_path / "r")
    (path,) = (tmp_path / "r" / "calibrations").glob("*.json")
    path.write_text(path.read_text().replace('"triad":', '"trial":'))
    row = load_records(tmp_path / "r").table.iloc[0]
    assert math.isnan(row["limit_ratio"]) and row["milliseconds"] > 0


def test_untimed_cells_have_no_times_and_need_no_calibration(tmp_path, fake_truth):
    records = run(Study(name="c", scenes=[Scene()], methods=[Fake()], size=(32, 24), repeats=0), tmp_path / "r")
    assert math.isnan(records[0].milliseconds) and records[0].repeats == 0 and records[0].calibration == ""
    assert records.table["relmse"][0] > 0
    json.dumps(records[0].as_content(), allow_nan=False)
