"""The atlas of fake failures, whose break points are known, and its page."""

import dataclasses

import numpy as np
import pytest

import interreflect as ir
from interreflect.stability.break_points import FAILED, WAITS, labels
from interreflect.stability.crossing import ALWAYS, BREAKS, NEVER
from interreflect.stability.failure import Failure, Reading

V = ir.methods.VoxelConeTracing
COARSE, FINE, PLAIN = V(grid=ir.Grid(resolution=16)), V(grid=ir.Grid(resolution=32)), ir.methods.ConstantAmbient()
measured = []


def thinner_than_a_voxel(trial):
    """Breaks where the value is below one voxel; without a grid never."""
    measured.append(trial.value)
    voxel = 1 / trial.method.knobs().get("grid.resolution", 10**6)
    image = np.full((12, 16, 3), trial.value, np.float32)
    return Reading(0.01 * voxel / trial.value, image, np.ones_like(image), signed=0.01 * voxel / trial.value)


def angry(trial):
    raise RuntimeError("it was too much")


THIN = Failure(
    name="leak through a test", knob="thickness", unit="extents", easy=0.5, hard=0.005,
    scene=lambda t: ir.scenes.thin_wall(thickness=min(t, 0.2)),
    measure=thinner_than_a_voxel, quantity="leak", truth="closed form", tolerance=0.01, reason="<one> voxel", stages=("march",),
)  # fmt: skip
ROWS = [
    THIN,
    dataclasses.replace(THIN, name="occlusion by a test", measure=lambda t: dataclasses.replace(thinner_than_a_voxel(t), error=1.0)),
    dataclasses.replace(THIN, name="anger", measure=angry),
    dataclasses.replace(THIN, name="later", stages=("telepathy",)),
]


@pytest.fixture(scope="module")
def atlas(tmp_path_factory):
    return ir.stability.atlas([COARSE, FINE, PLAIN], ROWS, seeds=(0, 1), folder=tmp_path_factory.mktemp("atlas"))


def test_break_points_are_a_row_per_method_and_failure_with_intervals(atlas):
    table = atlas.break_points
    assert len(table) == 3 * 4
    for method, voxels in (("voxel-cone-tracing resolution 16", 16), ("voxel-cone-tracing resolution 32", 32)):
        one = table.loc[(method, "leak through a test")]
        assert one["outcome"] == BREAKS and one["low"] <= 1 / voxels <= one["high"]
        assert one["break_point"] == pytest.approx(1 / voxels, rel=0.05) and one["voxels"] == pytest.approx(1, rel=0.05)
    outcomes = [table.loc[("constant-ambient", row.name)]["outcome"] for row in ROWS]
    assert outcomes == [NEVER, ALWAYS, FAILED, WAITS]
    assert table.loc[("constant-ambient", "anger")]["words"] == "RuntimeError: it was too much"
    assert table.loc[("constant-ambient", "later")]["words"] == "waits for stage telepathy"
    assert list(atlas.table.columns) == atlas.methods and "extents" in atlas.table.loc["leak through a test"].iloc[0]


def test_an_atlas_resumes(tmp_path):
    measured.clear()
    first = ir.stability.atlas([COARSE], [THIN], seeds=(0,), folder=tmp_path)
    count = len(measured)
    assert count == 6 + 4
    (victim, *_) = sorted(tmp_path.glob("*.npz"))
    victim.write_bytes(victim.read_bytes()[:100])
    again = ir.stability.atlas([COARSE], [THIN], seeds=(0,), folder=tmp_path)
    assert len(measured) == count + 1  # only what was damaged
    assert again.break_points.equals(first.break_points)
    ir.stability.atlas([COARSE], [THIN], seeds=(1,), folder=tmp_path)
    assert len(measured) == 2 * count + 1


def test_the_page_shows_every_cell_and_loads_nothing(atlas, tmp_path):
    text = atlas.save(tmp_path / "atlas.html").read_text()
    assert text.count("<svg") == 6 and text.count("<polyline") == 6  # three methods on two failures that ran
    assert "it was too much" in text and "waits for stage telepathy" in text and "&lt;one&gt; voxel" in text
    assert "http" not in text.replace("http-equiv", "")
    assert text.count('alt="before"') == text.count('alt="after"') == 2  # two methods break
    assert "Leak against over-occlusion" in text


def test_leaks_and_occlusion_are_drawn_against_each_other_with_a_mark_per_method(atlas):
    (axes,) = atlas.leak_against_occlusion().axes
    assert len(axes.collections) == 3
    swept = np.mean([0.01 / 16 / value for value in THIN.values(6)])  # the coarse grid's law, in both rows
    assert axes.collections[0].get_offsets().data[0] == pytest.approx((swept, swept))
    few = dataclasses.replace(atlas, cells=tuple(cell for cell in atlas.cells if cell.failure is THIN))
    with pytest.raises(ValueError, match="both a leak and an occlusion"):
        few.leak_against_occlusion()


def test_methods_are_told_apart_by_the_knobs_that_differ():
    assert list(labels([COARSE, PLAIN])) == ["voxel-cone-tracing", "constant-ambient"]
    assert list(labels([COARSE, V()])) == ["voxel-cone-tracing resolution 16", "voxel-cone-tracing"]
    assert list(labels({"coarse": COARSE, "the same": COARSE})) == ["coarse", "the same"]
    with pytest.raises(ValueError, match="two methods are the same"):
        labels([COARSE, COARSE])


def test_break_points_are_told_in_voxels_only_where_voxels_are_of_one_size(tmp_path):
    grids = {
        "even": ir.Grid(resolution=16),
        "warped": ir.Grid(resolution=16, warp=ir.Logistic()),
        "nested": ir.Grid(resolution=8, cascades=2),
    }
    methods = {name: V(grid=grid) for name, grid in grids.items()}
    table = ir.stability.atlas(methods, [THIN], seeds=(0,), folder=tmp_path, bisections=1).break_points
    known = table["voxels"].notna()
    assert (table["outcome"] == BREAKS).all() and known.tolist() == [True, False, False]


def test_an_atlas_of_nothing_is_refused():
    with pytest.raises(ValueError, match="at least one method"):
        ir.stability.atlas([], ROWS)
    with pytest.raises(ValueError, match="sweep of two values"):
        ir.stability.atlas([PLAIN], ROWS, sweep=1)


# A wall in one layer of voxels is lit on both sides; a shadow map's bias swallows shadows shorter than itself.
@pytest.mark.parametrize(
    ("name", "method"),
    [
        ("leak through a shifted wall", V(grid=ir.Grid(resolution=32))),
        ("holes and leaks of shadows", ir.methods.ConstantAmbient(shadow=ir.ShadowMap(size=256), ambient=0.0)),
    ],
)
def test_a_real_failure_runs_from_end_to_end(name, method, tmp_path):
    (row,) = (row for row in ir.stability.failures if row.name == name)
    atlas = ir.stability.atlas([method], [row], seeds=(0,), folder=tmp_path, sweep=4, bisections=1)
    assert atlas.break_points["outcome"].tolist() == [BREAKS]
