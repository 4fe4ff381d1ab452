"""Search over methods whose best settings are known, and the space that is searched."""

import math

import pytest
from search_fakes import Tunable
from study_fakes import Scene

import interreflect as ir
from interreflect.study.pareto import best, cheapest
from interreflect.study.reference import Reference
from interreflect.study.search import search
from interreflect.study.space import Axis, axes_of
from interreflect.study.study import Study

pytest.importorskip("optuna", reason="the extra `search` is not installed")


def study(**changes):
    given = {"name": "s", "scenes": [Scene()], "methods": [Tunable()], "size": (90, 75), "repeats": 1, "max_repeats": 1, "images": False}
    return Study(**given | {"reference": Reference(1e-5, 8192)} | changes)


def test_every_plain_knob_is_an_axis_but_what_the_picture_is_to_show():
    axes = {axis.path: axis for axis in axes_of(Tunable())}
    assert list(axes) == ["effort", "waste", "idle", "flag"]
    assert (axes["effort"].low, axes["effort"].high) == (2.5, 40)
    assert (axes["waste"].low, axes["waste"].high) == (1.25, 20)  # a quarter to four times
    assert axes["idle"].high == 1.0  # within what the knob allows
    assert axes["flag"].choices == (False, True)
    real = {axis.path: axis for axis in axes_of(ir.methods.VoxelConeTracing())}
    assert {"grid.resolution", "march.cones", "march.set", "glossy.step", "shadow.samples"} <= set(real)
    assert "bounces" not in {axis.path for axis in axes_of(ir.methods.PathTracing())}


def test_ranges_and_paths_may_be_given():
    (axis,) = axes_of(Tunable(), ranges={"effort": (1, 900)}, knobs=["effort"])
    assert (axis.low, axis.high) == (1, 900)
    with pytest.raises(TypeError, match="no plain knob 'efort'"):
        axes_of(Tunable(), knobs=["efort"])


def test_an_axis_covers_its_range():
    numbers = Axis("samples", 4, 1.0, 16.0, whole=True)
    assert [numbers.at(place) for place in (0, 0.5, 1)] == [1, 4, 16]
    assert numbers.neighbours(1.5) == [2, 6]
    assert Axis("set", "a", choices=("a", "b")).neighbours(2) == ["b"]
    assert Axis("level", 0.0, -1.0, 1.0).neighbours(2) == [-0.2, 0.2]


def test_a_search_finds_settings_that_beat_the_default(fake_truth, tmp_path):
    found = search(study(), trials=24, folder=tmp_path / "a", knobs=["effort", "waste", "flag"])
    assert found.records[0].knobs == Tunable().knobs()  # the first trial is the method as it was given
    within = cheapest(found.records, relmse=0.012)  # what the default reaches in 15 * .675 ms
    assert float(within["milliseconds"].iloc[0]) < 0.6 * 15 * 0.675
    assert found.pruned and all(record.size == (30, 25) for record in found.pruned)
    assert len(found.records) + len(found.pruned) <= 24


def test_a_search_resumes_without_measuring(fake_truth, tmp_path):
    first = search(study(), trials=8, folder=tmp_path / "a")
    cells = {path: path.stat().st_mtime_ns for path in (tmp_path / "a" / "cells").iterdir()}
    again = search(study(), trials=8, folder=tmp_path / "a")
    assert {path: path.stat().st_mtime_ns for path in (tmp_path / "a" / "cells").iterdir()} == cells
    assert [record.key for record in again.records] == [record.key for record in first.records]


def test_cheapest_and_best_search_a_study(fake_truth, tmp_path):
    options = {"folder": tmp_path / "a", "knobs": ["effort", "waste"]}
    (row,) = best(study(), milliseconds=6.0, trials=16, options=options).to_dict("records")
    assert row["milliseconds"] <= 6.0
    (row,) = cheapest(study(), trials=16, options=options, relmse=0.05).to_dict("records")
    assert row["relmse"] <= 0.05


def test_settings_that_fail_do_not_end_a_search(fake_truth, tmp_path):
    found = search(study(), trials=12, ranges={"effort": (100, 1000)}, knobs=["effort"], folder=tmp_path / "a")
    assert found.failed > 0
    assert all(record.status == "failed" or math.isfinite(record.milliseconds) for record in found.records)
