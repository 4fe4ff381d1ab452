"""Every experiment is a question, a study and a chart of its records; each runs at a small size."""

import dataclasses
import runpy
from pathlib import Path

import pandas as pd
import pytest
from experiments import head_to_head
from experiments import where_do_caches_break as caches
from experiments import where_do_virtual_lights_break as virtual
from experiments import where_do_voxels_break as where
from experiments import where_does_illuminance_composition_break as composition
from experiments.figures import draw
from matplotlib.figure import Figure

import interreflect as ir
from interreflect.stability.composition_failures import COMPOSITION

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
        "head_to_head",
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


@pytest.fixture(scope="module")
def contest(tmp_path_factory):
    """Three ways and black on the Cornell box, few pixels."""
    folder = tmp_path_factory.mktemp("contest")
    kept = ("direct light alone", "16 lights, a ray each", "64 lights, a ray each", "denoised paths, 1 a pixel")
    few = {name: head_to_head.rivals()[name] for name in kept}
    few["cones"] = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16))
    name = "Cornell box by a spot"
    place = dataclasses.replace(head_to_head.PLACES[name], spp=16)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("INTERREFLECT_CACHE", str(folder / "cache"))
        for what, value in {"rivals": lambda: few, "SIZE": (48, 28), "SEEDS": (0, 1), "PLACES": {name: place}}.items():
            patch.setattr(head_to_head, what, value)
        yield folder, few, head_to_head.measure(folder, [name])


def test_who_wins_a_head_to_head_is_told_by_both_errors_with_black_among_them(contest):
    folder, few, found = contest
    (records,) = found.values()
    table = head_to_head.winners(records)
    assert set(table["setting"]) <= set(few) and set(table["by"]) == {"relmse", "flip"}
    black = table[table["method"] == "constant-ambient"]
    assert len(black) and set(black["setting"]) == {"direct light alone"} and not black["beats_black"].any()
    for (_, by), ranked in table.groupby(["budget", "by"]):
        assert ranked[by].is_monotonic_increasing and list(ranked["place"]) == list(range(1, len(ranked) + 1))
        assert (ranked["milliseconds"] <= ranked["budget"]).all()
    kept = folder / "cornell_box_by_a_spot"
    assert all((kept / name).exists() for name in ("winners.csv", "speed_accuracy.png", "pictures.png"))
    assert all(axes.has_data() for axes in head_to_head.chart(found).axes)
    assert "direct light alone relMSE" in head_to_head.told("box", records)


def test_a_head_to_head_leaves_out_a_scene_that_is_not_here(monkeypatch, capsys, tmp_path):
    def absent():
        raise FileNotFoundError("tried here and there")

    monkeypatch.setattr(head_to_head, "PLACES", {"far": head_to_head.Place(absent, "court", 2)})
    assert head_to_head.measure(tmp_path, ["far"]) == {}
    assert "far: left out" in capsys.readouterr().out
