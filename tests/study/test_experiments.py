"""Every experiment is a question, a study and a chart of its records; each runs at a small size."""

import dataclasses
import runpy
from functools import partial
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from experiments import (
    do_rays_with_shared_samples_beat_cones,
    do_warps_pay,
    head_to_head,
    what_does_each_scene_need,
    when_is_tessellation_worth_it,
    which_stage_costs_most_error,
)
from experiments import where_do_caches_break as caches
from experiments import where_do_virtual_lights_break as virtual
from experiments import where_do_voxels_break as where
from experiments import where_does_illuminance_composition_break as composition
from experiments.figures import draw
from experiments.shared.contenders import contenders
from experiments.shared.moving import in_motion
from experiments.shared.places import Place, moved, places
from experiments.shared.ratios import ratio
from experiments.shared.winners import ranked, tied, winners_in_motion
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.stability.composition_failures import COMPOSITION
from interreflect.study.ladder import ladder, mechanisms

FOLDER = Path(__file__).parents[2] / "experiments"
FILES = sorted(path for path in FOLDER.glob("*.py") if path.stem not in ("__init__", "figures", "gallery"))
EXPERIMENTS = [path for path in FILES if "\nstudy = " in path.read_text()]


def smaller(study):
    """The same question of one scene, with few pixels, seeds and samples, grids that take no time, and 24 of very many methods."""
    less = {"grid.resolution": lambda n: 8 + n // 16, "march.cones": lambda n: 3 + n // 8, "march.samples": lambda n: 1 + n // 16}
    less |= {"place_surfels.surfels": lambda n: n // 32, "place_caches.texels": lambda n: n // 8}
    less |= {f"place_caches.{grid}{axis}": lambda n: 2 + n // 8 for grid in ("", "grid.") for axis in ("nx", "ny", "nz")}
    methods = []
    for method in study.methods:
        knobs = method.knobs()
        changed = method.replace({name: shrink(knobs[name]) for name, shrink in less.items() if name in knobs})
        if changed not in methods and knobs.get("spp", 0) <= 16:
            methods.append(changed)
    return dataclasses.replace(
        study,
        scenes=study.scenes[:1],
        methods=methods[:24] if len(methods) > 80 else methods,
        size=(48, 32),
        seeds=study.seeds[:2],
        repeats=1,
        max_repeats=1,
        reference=ir.Reference(max_spp=16),
    )


@pytest.mark.parametrize("path", EXPERIMENTS, ids=lambda path: path.stem)
def test_an_experiment_is_a_question_whose_records_make_its_chart(path, tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    experiment = runpy.run_path(str(path))
    assert "?" in experiment["__doc__"].splitlines()[0]
    records = ir.run(smaller(experiment["study"]), tmp_path / "r")
    assert len(records) >= 4
    assert set(records.table["status"]) == {"ok"}
    figure = experiment["chart"](records)
    assert isinstance(figure, Figure)
    figure.canvas.draw()
    assert all(axes.get_xlabel() and axes.get_ylabel() and axes.has_data() for axes in figure.axes)


def test_what_is_no_study_measures_by_itself():
    alone = {
        "do_rays_with_shared_samples_beat_cones",
        "do_warps_pay",
        "head_to_head",
        "what_does_each_scene_need",
        "when_is_tessellation_worth_it",
        "where_does_every_method_break",
        "which_stage_costs_most_error",
        "where_do_caches_break",
        "where_do_virtual_lights_break",
        "where_do_voxels_break",
        "where_does_illuminance_composition_break",
    }
    assert {path.stem for path in FILES if path not in EXPERIMENTS} == alone


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    """Break points of coarse voxels in two grids and with a filter that thins walls, at three failures that take no truth."""
    folder = tmp_path_factory.mktemp("break")
    rows = ("leak through a thin wall", "occlusion by a wall", "opaque layer, opacity by the step's length")
    small = {"grids": {name: where.grids[name] for name in ("even", "Spherical")}, "filters": {"mean": where.filters["VolumeCoverage"]}}
    methods = {atlas: {name: m.replace({"grid.resolution": 16}) for name, m in ways.items()} for atlas, ways in small.items()}
    return folder, where.measure(folder, rows, methods, seeds=(0,), sweep=2, bisections=1)


def test_break_points_of_voxels_are_written_drawn_and_told(broken):
    folder, found = broken
    assert list(found) == ["grids", "filters"] and all(len(atlas.failures) == 3 for atlas in found.values())
    kept = pd.read_csv(folder / "break_points.csv", index_col=["atlas", "method", "failure"])
    assert len(kept) == 3 * 3 and set(kept["outcome"]) <= {"breaks", "never", "always", "reversed"}
    assert (folder / "grids.html").exists() and (folder / "filters.html").exists()
    told = where.table(found["filters"])
    assert told.loc["opaque layer, opacity by the step's length", "mean"] == "always"  # it never closes
    figure = where.chart(found)
    figure.canvas.draw()
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert len(texts) == 3 * 3 and "always" in texts


def test_what_a_question_measures_by_itself_is_drawn_like_any_other(broken, monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(where, "measure", lambda folder: asked.append(folder) or broken[1])
    (path,) = draw("where_do_voxels_break", tmp_path)
    assert asked == [tmp_path / "where_do_voxels_break"] and path.read_bytes().startswith(b"%PDF")


def test_break_points_of_voxels_cover_every_grid_and_every_filter():
    warps = {method.knobs()["grid.warp"] for method in where.grids.values()}
    assert warps == {technique.__name__ for technique in (ir.Linear, ir.Logistic, ir.CubicSpline, ir.Perspective, ir.Spherical)}
    assert any(method.knobs()["grid.cascades"] > 1 for method in where.grids.values())
    assert {m.knobs()["prefilter"] for m in where.filters.values()} == {technique.__name__ for technique in ir.techniques("prefilter")}
    assert set(where.FAILURES) <= {row.name for row in ir.stability.failures}


def test_break_points_of_caches_are_measured_for_places_and_ways_to_read(tmp_path):
    row = "pixels without a cache on wires"
    small = {
        "placed": ({name: caches.placed[name] for name in ("Clustered", "Equidistant")}, [row]),
        "read": ({name: caches.read[name] for name in ("Gather", "Gather, half a tile")}, [row]),
    }
    found = caches.measure(tmp_path, small, sweep=2, bisections=1)
    assert found["placed"].cell("Clustered", row).outcome == found["read"].cell("Gather", row).outcome == "never"
    assert found["placed"].cell("Equidistant", row).outcome == "always"
    assert len(caches.table(found["read"]).loc[row]) == 2 and (tmp_path / "placed.html").exists()
    caches.chart(found).canvas.draw()


def test_break_points_of_caches_cover_every_way_to_share_one():
    used = {stage: {m.knobs()[stage] for ways in (caches.placed, caches.read, caches.held) for m in ways.values()}
            for stage in ("distribute", "interpolate", "preconvolve")}  # fmt: skip
    for stage, names in used.items():
        assert names == {technique.__name__ for technique in ir.techniques(stage)} - {"CachePerPixel"}  # which pixels do not share
    assert set(caches.FAILURES) <= {row.name for row in ir.stability.failures}


def test_break_points_of_virtual_lights_are_measured_for_clusters_and_maps(tmp_path):
    flux, umbra = "flux of clusters on chequers", "light in an umbra by pull and push"
    small = {
        "clustered": ({name: virtual.clustered[name].replace(map_size=64) for name in ("KMeans", "flux at the centre")}, [flux]),
        "mapped": ({"TracedVisibility": virtual.mapped["TracedVisibility"].replace(map_size=64)}, [umbra]),
    }
    found = virtual.measure(tmp_path, small, sweep=2, bisections=1)
    assert found["clustered"].cell("KMeans", flux).outcome == "never" != found["clustered"].cell("flux at the centre", flux).outcome
    assert found["mapped"].cell("TracedVisibility", umbra).outcome == "never" and (tmp_path / "mapped.html").exists()
    virtual.chart(found).canvas.draw()


def test_break_points_of_virtual_lights_cover_every_shade_and_filter():
    for stage, ways in (("shade_lights", virtual.shaded), ("filter_shadows", virtual.filtered)):
        assert {m.knobs()[stage] for m in ways.values()} == {technique.__name__ for technique in ir.techniques(stage)}
    assert {name for _, rows in virtual.ATLASES.values() for name in rows} <= {row.name for row in ir.stability.failures}


def test_break_points_of_illuminance_composition_are_measured_for_caches(tmp_path):
    cells = "bleeding through a cell"
    found = composition.measure(tmp_path, {"placed": ({"a map of 64": composition.base}, [cells])}, sweep=2, bisections=0)
    assert found["placed"].cell("a map of 64", cells).outcome == "breaks"
    composition.chart(found).canvas.draw()


def test_break_points_of_illuminance_composition_name_failures_that_exist():
    named = {name for _, rows in composition.ATLASES.values() for name in rows}
    assert {row.name for row in COMPOSITION} <= named <= {row.name for row in ir.stability.failures}


KEPT = ("direct light alone", "16 lights, a ray each", "cones, grid 32, interleaved", "denoised paths, 1 a pixel")


@pytest.fixture(scope="module")
def contest(tmp_path_factory):
    """Three ways and black on the Cornell box, few pixels."""
    folder = tmp_path_factory.mktemp("contest")
    truth = ir.Reference(noise=1e-2, max_spp=16)
    smaller = {"SIZE": (48, 28), "SEEDS": (0, 1), "FRAMES": 3, "TRUTH": {1: truth, None: truth}, "TRUTH_OF_A_FRAME": truth}
    few = {light: {name: way for name, way in contenders(light).items() if name in KEPT} for light in (1, None)}
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
        for what, value in (smaller | {"contenders": few.get}).items():
            patch.setattr(head_to_head, what, value)
        yield folder, head_to_head.measure(folder, ["cornell box by a spot"])


def test_who_wins_a_head_to_head_is_told_still_and_moving_by_every_error_with_black_among_them(contest):
    folder, found = contest
    assert set(found["setting"]) <= set(KEPT) and "direct light alone" in set(found["setting"])
    assert set(found["light"]) == {"one bounce", "all bounces"} and set(found["kind"]) == {"still", "moving"}
    assert set(found[found["kind"] == "moving"]["by"]) == {"relmse", "flip", "temporal"}
    for (_, _, budget, _), rows in found.groupby(["light", "kind", "budget", "by"]):
        assert rows["error"].is_monotonic_increasing and list(rows["place"]) == list(range(1, len(rows) + 1))
        assert rows["method"].is_unique and (rows["milliseconds"] <= budget).all()
    assert "direct light alone" not in set(found[found["by"] == "temporal"]["setting"])
    assert "How often each method is first" in (folder / "winners.md").read_text()
    kept = folder / "cornell_box_by_a_spot" / "all_bounces"
    assert all((kept / name).exists() for name in ("page.html", "moving.csv", "speed_accuracy.png"))
    head_to_head.chart(found).canvas.draw()


def test_what_was_played_in_motion_is_not_played_again(contest, monkeypatch):
    folder, found = contest
    monkeypatch.setattr("experiments.shared.moving._played", lambda *_: pytest.fail("played again"))
    again = head_to_head.measure(folder, ["cornell box by a spot"])
    pd.testing.assert_frame_equal(again, found)


def test_a_way_that_fails_in_motion_is_a_row_with_its_reason(tmp_path):
    scene = ir.scenes.cornell_box(light="spot")
    bad = {"none": ir.methods.PathTracing(spp=1)}
    motion = ir.Motion(frames=2, light=7, light_turn=1)
    found = in_motion(bad, scene, motion, (8, 6), 1, ir.Reference(max_spp=2), tmp_path)
    assert "Motion.light must name" in found["failure"].iloc[0]
    assert winners_in_motion(found.assign(milliseconds=1.0, relmse=0.0, flip=0.0, temporal=0.0)).empty


def test_a_lead_that_intervals_cover_is_within_noise_and_a_tie():
    rows = [("a", 0.10, 0.01), ("b", 0.11, 0.01), ("c", 0.3, 0.01)]
    table = pd.DataFrame(
        [
            {"setting": m, "method": m, "milliseconds": 10.0, "milliseconds_low": 9.0, "milliseconds_high": 11.0}
            | {"flip": e, "flip_low": e - r, "flip_high": e + r}
            for m, e, r in rows
        ]
    )
    found = ranked(table, ("flip",), {})
    first = found[found["budget"] == 50]
    assert list(first["note"]) == ["within noise", "", ""] and list(tied(first)["method"]) == ["a", "b"]
    assert first["times_best"].iloc[2] == pytest.approx(3.0)


def test_every_manifest_of_the_scenes_folder_is_a_place(tmp_path, monkeypatch):
    for name in ("one/scene.toml", "two/lit.toml"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("")
    monkeypatch.setenv("INTERREFLECT_SCENES", str(tmp_path))
    assert list(places()) == ["cornell box by a spot", "atrium", "one", "two/lit"]


def test_a_place_in_motion_moves_its_camera_sideways_and_a_light():
    scene = ir.scenes.cornell_box(light="spot")
    (before, first), (after, second) = (moved(scene, 2).at(scene, k) for k in range(2))
    step = np.subtract(second.position, first.position)
    assert np.linalg.norm(step) > 0 and abs(step @ np.subtract(first.target, first.position)) < 1e-6
    assert before.lights != after.lights


TOLD = (do_warps_pay, when_is_tessellation_worth_it, do_rays_with_shared_samples_beat_cones)


@pytest.mark.parametrize("question", TOLD, ids=lambda question: question.__name__.rpartition(".")[2])
def test_a_finding_is_drawn_and_told_with_intervals(question, tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    boxes = [ir.scenes.cornell_box(light=light) for light in ("spot", "area", "point")]
    study = dataclasses.replace(smaller(question.study_of(boxes)), scenes=boxes)
    records = ir.run(study, tmp_path / "r")
    assert set(records.table["status"]) == {"ok"}
    found = question.table(records, boxes) if hasattr(question, "table") else records
    question.chart(found).canvas.draw()
    words = question.told(found)
    assert "[" in words and "over 3 views" in words and "nan" not in words


def test_findings_of_stages_and_mechanisms_are_drawn_and_told(tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    for question in (which_stage_costs_most_error, what_does_each_scene_need):
        monkeypatch.setattr(question, "SIZE", (24, 16))
        monkeypatch.setattr(question, "REFERENCE", ir.Reference(max_spp=16))
    monkeypatch.setattr(which_stage_costs_most_error, "SAMPLES", 4)
    monkeypatch.setattr(ir, "ladder", lambda *given, **named: ladder(*given, **named, rungs=mechanisms()[:3]))
    boxes = [Place(light, partial(ir.scenes.cornell_box, light=light)) for light in ("spot", "point")]
    coarse = {"cones": ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=8))}
    shares = which_stage_costs_most_error.measure(tmp_path / "shares", boxes, coarse)
    assert {"march", "rest", "interaction"} <= set(shares["stage"])
    assert "cones, over 2 scenes: " in which_stage_costs_most_error.told(shares)
    needs = what_does_each_scene_need.measure(tmp_path / "needs", boxes)
    assert "constant ambient: needed on" in what_does_each_scene_need.told(needs)
    for figure in (which_stage_costs_most_error.chart(shares), what_does_each_scene_need.chart(needs)):
        figure.canvas.draw()


def test_a_ratio_over_views_is_a_geometric_mean_with_its_interval():
    found = ratio([0.5, 2.0, 1.0])
    assert found.mean == pytest.approx(1.0) and found.low < 0.5 < 2.0 < found.high and found.verdict.startswith("no different")
    assert ratio([0.5, 0.51, 0.49]).verdict == "less"
    with pytest.raises(ValueError, match="positive and finite"):
        ratio([1.0, -1.0])
