"""Studies with fake methods, whose rows are known: every cell is there, failures are rows, nothing is measured twice."""

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from study_fakes import Camera, Fake, Scene, lasting

from interreflect.study.files import HOST
from interreflect.study.reference import Reference
from interreflect.study.run import run
from interreflect.study.store import Store, load_records
from interreflect.study.study import Study, sweep

pytestmark = pytest.mark.usefixtures("fake_truth")


def small(**changes):
    values = {"name": "small", "scenes": [Scene()], "methods": [Fake()], "size": (32, 24), "repeats": 1, "max_repeats": 1}
    return Study(**values | changes)


@pytest.fixture
def renders_of(tmp_path, monkeypatch):
    """Runs a study and counts what was rendered for it, warm-up included."""
    renders = tmp_path / "renders"
    monkeypatch.setenv("STUDY_FAKES_RENDERS", str(renders))

    def counted(study, folder):
        renders.write_bytes(b"")
        records = run(study, folder)
        return len(renders.read_bytes()), records

    return counted


def test_a_sweep_is_every_combination_last_axis_fastest():
    methods = sweep(Fake, {"error": [0.1, 0.2], "time": [1.0, 2.0, 3.0]})
    assert [(m.error, m.time) for m in methods] == [(e, t) for e in (0.1, 0.2) for t in (1.0, 2.0, 3.0)]


def test_a_sweep_starts_from_a_method_with_knobs_set():
    assert {m.mode for m in sweep(Fake(mode="nan"), {"error": [0.1, 0.2]})} == {"nan"}


@pytest.mark.parametrize("values", [[], "ab", 3])
def test_an_axis_must_be_a_sequence_of_values(values):
    with pytest.raises(ValueError, match="axis 'error'"):
        sweep(Fake, {"error": values})


def test_an_unknown_knob_is_a_type_error():
    with pytest.raises(TypeError, match="no knob"):
        sweep(Fake, {"eror": [1]})


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("scenes", []),
        ("methods", []),
        ("seeds", []),
        ("methods", [Fake]),
        ("methods", [Fake(), Fake()]),
        ("size", (0, 3)),
        ("size", (4,)),
        ("seeds", [-1]),
        ("seeds", [0.5]),
        ("seeds", [1, 1]),
        ("scenes", [Scene(), Scene("again")]),
        ("bounces", -1),
        ("bounces", "all"),
        ("repeats", -1),
        ("max_repeats", 0),
        ("threads", 0),
        ("cameras", ["back"]),
        ("cameras", "front"),
        ("scenes", [Scene(cameras={})]),
        ("name", ""),
        ("reference", 3),
    ],
)
def test_a_study_names_the_field_that_is_wrong(field, value):
    with pytest.raises(ValueError, match=rf"Study\.\w*{field[:4]}"):
        small(**{field: value})


@pytest.mark.parametrize("settings", [{"noise": 0}, {"noise": math.nan}, {"max_spp": 1}, {"max_spp": 2.5}])
def test_reference_settings_are_checked(settings):
    with pytest.raises(ValueError, match=r"Reference\."):
        Reference(**settings)


def test_the_table_has_a_row_for_every_scene_camera_method_and_seed(tmp_path):
    two = Scene("two", 2.0, {"front": Camera(), "side": Camera((1.0, 0.0, 0.0))})
    study = small(scenes=[Scene(), two], cameras=["side", "front"], methods=sweep(Fake, {"error": [0.1, 0.2]}), seeds=range(2))
    table = run(study, tmp_path / "r").table
    expected = [("plain", "front", e, s) for e in (0.1, 0.2) for s in (0, 1)]
    expected += [("two", camera, e, s) for camera in ("side", "front") for e in (0.1, 0.2) for s in (0, 1)]
    assert list(table[["scene", "camera", "error", "seed"]].itertuples(index=False, name=None)) == expected
    assert (table["status"] == "ok").all()


def test_metrics_and_times_are_those_of_the_method(tmp_path):
    row = run(small(methods=[Fake(error=0.2, time=3.0)]), tmp_path / "r").table.iloc[0]
    # indirect is a quarter of the light and 20 % too bright; noise of the truth's indirect mean: .1 / sqrt(16 * 2304 values)
    assert row["energy_ratio"] == pytest.approx(1.05, abs=4 * 0.25 * 0.1 / math.sqrt(16 * 2304))
    assert row["indirect_energy_ratio"] == pytest.approx(1.2, abs=4 * 1.2 * 0.1 / math.sqrt(16 * 2304))
    assert (row["milliseconds"], row["milliseconds_p95"], row["precompute_milliseconds"]) == (3.0, 3.0, 7.0)
    assert (row["stage.march.milliseconds"], row["stage.march.rays"], row["stage.march.bytes"]) == (2.25, 10, 64)


def test_bounces_of_the_truth_are_one_for_all_or_each_methods_own(tmp_path):
    methods = [Fake(), Fake(error=0.2, bounces=None)]
    own = run(small(methods=methods, bounces="method"), tmp_path / "own").table
    assert list(own["bounces"]) == [1, "all"]
    assert list(own["warnings"]) == ["", ""]
    one = run(small(methods=methods, bounces=1), tmp_path / "one").table
    assert list(one["bounces"]) == [1, 1]
    assert one["warnings"][1] == "the method makes all indirect bounces, the truth has 1"


@pytest.mark.parametrize(
    ("mode", "status", "words"),
    [
        ("raises", "failed", "RuntimeError: lamp broken"),
        ("unprepared", "failed", "RuntimeError: no room"),
        ("small", "failed", "shape must be"),
        ("nan", "not finite", "2 numbers of the picture are not finite"),
    ],
)
def test_failures_and_nan_are_rows_that_say_why(tmp_path, mode, status, words):
    table = run(small(methods=[Fake(mode=mode), Fake()]), tmp_path / "r").table
    assert list(table["status"]) == [status, "ok"]
    assert words in table["failure"][0]
    assert math.isnan(table["relmse"][0])
    assert math.isfinite(table["relmse"][1])


def test_a_truth_that_fails_is_a_row_too(tmp_path):
    table = run(small(scenes=[Scene(level=math.inf)]), tmp_path / "r").table
    assert table["failure"][0].startswith("reference: ValueError")


def test_pictures_too_small_for_a_metric_have_it_as_nan_with_the_reason(tmp_path):
    row = run(small(size=(8, 8)), tmp_path / "r").table.iloc[0]
    assert row["status"] == "ok"
    assert math.isnan(row["ssim"])
    assert "ssim needs at least" in row["warnings"]
    assert math.isfinite(row["relmse"])


def test_a_study_run_twice_does_nothing_the_second_time(tmp_path, renders_of):
    study = small(methods=[Fake(), Fake(error=0.3), Fake(mode="raises")], seeds=range(3))
    first, records = renders_of(study, tmp_path / "r")
    second, again = renders_of(study, tmp_path / "r")
    assert (first, second) == (2 * 6 + 3, 0)  # warm-up and one repeat each; the failing one raises at once
    pd.testing.assert_frame_equal(records.table, again.table)
    pd.testing.assert_frame_equal(records.table, load_records(tmp_path / "r").table)


def test_a_larger_study_measures_only_what_is_new(tmp_path, renders_of):
    run(small(methods=[Fake()]), tmp_path / "r")
    assert renders_of(small(methods=[Fake(error=0.3), Fake()], seeds=range(2)), tmp_path / "r")[0] == 2 * 3
    assert len(load_records(tmp_path / "r")) == 4


@pytest.mark.parametrize(
    "change",
    [
        {"size": (33, 24)},
        {"seeds": [9]},
        {"reference": Reference(2e-3)},
        {"threads": 1},
        {"bounces": 2},
        {"scenes": [Scene(cameras={"front": Camera((5.0, 0.0, 0.0))})]},
        {"max_repeats": 2},
        {"scenes": [Scene(level=2.0)]},
        {"methods": [Fake(error=0.5)]},
    ],
)
def test_whatever_determines_a_cell_makes_another_cell(tmp_path, change, renders_of):
    run(small(), tmp_path / "r")
    assert renders_of(small(**change), tmp_path / "r")[0] > 0


def test_a_renamed_scene_or_camera_is_the_same_cell_under_its_new_name(tmp_path, renders_of):
    run(small(), tmp_path / "r")
    renders, records = renders_of(small(scenes=[Scene("renamed", cameras={"eye": Camera()})]), tmp_path / "r")
    assert renders == 0
    assert list(records.table[["scene", "camera"]].iloc[0]) == ["renamed", "eye"]


@pytest.mark.parametrize(
    "harm",
    [lambda text: text[: len(text) // 2], lambda text: text.replace('"ok"', '"oh"'), lambda text: "", lambda text: "[" * 100_000],
)
def test_a_damaged_record_is_set_aside_and_measured_again(tmp_path, harm, renders_of):
    study = small(seeds=range(2))
    whole = run(study, tmp_path / "r").table
    path = tmp_path / "r" / "cells" / f"{whole['key'][1]}.json"
    path.write_text(harm(path.read_text()))
    damaged = load_records(tmp_path / "r")
    assert (len(damaged), len(damaged.damaged)) == (1, 1)
    renders, again = renders_of(study, tmp_path / "r")
    assert renders == 2
    pd.testing.assert_frame_equal(lasting(again.table), lasting(whole))
    assert path.with_name(path.name + ".damaged").exists()


def test_a_damaged_picture_is_measured_again(tmp_path, renders_of):
    records = run(small(), tmp_path / "r")
    path = tmp_path / "r" / "images" / f"{records[0].key}.npz"
    content = bytearray(path.read_bytes())
    content[len(content) // 3] ^= 1
    path.write_bytes(bytes(content))
    assert renders_of(small(), tmp_path / "r")[0] == 2
    assert path.with_name(path.name + ".damaged").exists()


def test_a_truncated_truth_is_set_aside_and_made_again(tmp_path, fake_truth):
    whole = run(small(), tmp_path / "r").table
    (path,) = fake_truth.glob("*.npz")
    path.write_bytes(path.read_bytes()[:-100])
    again = run(small(), tmp_path / "other").table
    assert list(again["relmse"]) == list(whole["relmse"])
    assert list(fake_truth.glob("*.damaged"))


def test_pictures_and_truths_stay_beside_the_records(tmp_path):
    records = run(small(), tmp_path / "r")
    image, indirect = load_records(tmp_path / "r").images(records[0])
    truth, truth_indirect = records.truth(records[0])
    assert image.shape == indirect.shape == truth.shape == truth_indirect.shape == (24, 32, 3)
    assert np.mean((image - truth) ** 2) > 0


def test_without_images_only_records_are_written(tmp_path):
    run(small(images=False), tmp_path / "r")
    assert not list(tmp_path.glob("r/images/*")) + list(tmp_path.glob("r/truths/*"))


def test_every_record_names_what_made_it(tmp_path):
    record = run(small(threads=1), tmp_path / "r")[0]
    assert (record.scene_hash, record.method, record.seed, record.threads) == (Scene().hash, "fake", 0, 1)
    assert record.knobs == {"error": 0.1, "time": 1.0, "mode": "ok"}
    assert {"processor", "compiler", "commit", "libraries"} <= set(record.machine)
    row = load_records(tmp_path / "r").table.iloc[0]
    assert row["processor"] == record.machine["processor"]


def test_records_are_standard_json(tmp_path):
    run(small(methods=[Fake(mode="nan")]), tmp_path / "r")
    (path,) = (tmp_path / "r" / "cells").glob("*.json")

    def refuse(constant):
        raise AssertionError(f"{constant} is not JSON")

    json.loads(path.read_text(), parse_constant=refuse)


def test_a_record_of_another_format_version_says_so(tmp_path):
    run(small(), tmp_path / "r")
    (path,) = (tmp_path / "r" / "cells").glob("*.json")
    path.write_text(json.dumps(json.loads(path.read_text()) | {"format": 99}))
    with pytest.raises(ValueError, match="format version must be 2, got 99"):
        load_records(tmp_path / "r")


def test_a_folder_without_a_study_is_not_found(tmp_path):
    with pytest.raises(FileNotFoundError, match="no study"):
        load_records(tmp_path)


@pytest.mark.parametrize("limit", [{"timeout": 0}, {"timeout": "soon"}, {"memory": -1}, {"memory": math.nan}])
def test_limits_are_above_zero(tmp_path, limit):
    with pytest.raises(ValueError, match=f"{next(iter(limit))} must be"):
        run(small(), tmp_path / "r", **limit)
    assert not Path(tmp_path / "r").exists()


def test_half_written_files_of_dead_processes_are_cleared(tmp_path):
    run(small(), tmp_path / "r")
    cells = tmp_path / "r" / "cells"
    stale = cells / f"x.json.{HOST}.{2**22 + 1}.part"  # above the largest process number
    elsewhere = cells / f"x.json.another-{HOST}.{2**22 + 1}.part"  # nobody knows here whether it lives
    for part in (stale, elsewhere):
        part.write_text("half")
    run(small(), tmp_path / "r")
    assert (stale.exists(), elsewhere.exists()) == (False, True)


def test_a_records_stages_come_back_in_the_order_in_which_they_ran(tmp_path):
    record = run(small(images=False), tmp_path / "r")[0]
    ran = {name: {"milliseconds": 1.0, "bytes": 0, "counts": {}} for name in ("voxelize", "gbuffer", "shade", "march", "a")}
    store = Store(tmp_path / "r")
    store.write(dataclasses.replace(record, stages=ran))
    again, loaded = store.read(record.key), load_records(tmp_path / "r")
    columns = [name.split(".")[1] for name in loaded.table if name.startswith("stage.") and name.endswith(".milliseconds")]
    assert list(again.stages) == list(loaded[0].stages) == columns == list(ran)
