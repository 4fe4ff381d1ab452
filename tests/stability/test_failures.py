"""The table of failures: every row runs, and its truth holds for a method without approximations."""

import dataclasses

import numpy as np
import pytest

import interreflect as ir
from interreflect.scenes.builtin.blocked_sky import sky_share

ROWS = {row.name: row for row in ir.stability.failures}
CLOSED = [row for row in ir.stability.failures if row.truth.startswith("closed form")]
UNCHANGED = [row for row in ir.stability.failures if row.truth.startswith("the picture")]
IN_MOTION = [row for row in ir.stability.failures if "every frame" in row.truth]
COMPARED = [row for row in ir.stability.failures if row not in (*CLOSED, *UNCHANGED, *IN_MOTION)]
names = pytest.mark.parametrize


def test_the_table_has_every_row_of_ground_truth():
    assert len(ir.stability.failures) >= 19 and len(ROWS) == len(ir.stability.failures)
    for word in ("leak", "occlusion", "banding", "self-illumination", "flicker", "popping", "without light", "singularity", "shadows",
                 "clusters", "penumbra", "ringing", "probes", "corridors", "links", "texels", "chrominance", "scaled", "moved", "albedo",
                 "roughness", "Phong", "black", "angle", "off the grid", "sky through", "shadow map", "layer",
                 "without a cache", "depth edge", "sharp lobe", "see the sky alone", "umbra by points",
                 "gap", "churn", "chequers", "made anew", "two layers", "by bound", "lost to a bound", "by links", "few links",
                 "behind other", "negative radiance", "few bands", "through a cell", "far light"):  # fmt: skip
        assert any(word in name for name in ROWS), word


@names("row", ir.stability.failures, ids=lambda row: row.name)
def test_every_row_says_what_it_is(row):
    for field in ("knob", "quantity", "truth", "reason"):
        assert getattr(row, field)
    assert row.tolerance > 0
    assert row.at(0) == pytest.approx(row.easy) and row.at(1) == pytest.approx(row.hard)
    for share in (0.2, 0.7):
        assert row.share(row.at(share)) == pytest.approx(share)
    for value in row.values(3):
        assert row.scene(value).triangles > 0


def test_rows_whose_stages_do_not_exist_say_which_they_wait_for():
    from interreflect import _core

    for row in ir.stability.failures:
        exists = not row.stages or any(stage in _core.stages for stage in row.stages)
        assert bool(row.waits) != exists
        assert exists or row.stages[0] in row.waits


# As many paths as bring noise well below the tolerances; where the truth is 0, none is too few.
@names("share", [0.0, 1.0])
@names("row", CLOSED, ids=lambda row: row.name)
def test_closed_forms_hold_for_path_tracing(row, share):
    paths = 256 if row.name == "penumbra" else 1 if row.truth == "closed form: 0" else 16
    reading = row.read(ir.methods.PathTracing(spp=paths), row.at(share))
    assert reading.error < 0.3 * row.tolerance


@pytest.mark.long
@names("share", [0.0, 1.0])
@names("row", COMPARED, ids=lambda row: row.name)
def test_references_hold_for_path_tracing_of_another_seed(row, share):
    """Truth and metric are sound: what has no approximation stays within the tolerance, and about as far off as the truth's own noise."""
    reading = row.read(ir.methods.PathTracing(spp=2048), row.at(share), seed=9)
    assert reading.error < 0.9 * row.tolerance
    assert reading.error < 4 * reading.floor + 0.05 * row.tolerance


@pytest.mark.long
@names("row", [row for row in IN_MOTION if not row.waits], ids=lambda row: row.name)
def test_motion_in_many_samples_is_steady(row):
    reading = row.read(ir.methods.PathTracing(spp=1024), row.at(0.4), seed=9)
    assert reading.error < row.tolerance


@names("row", UNCHANGED, ids=lambda row: row.name)
def test_a_picture_is_the_same_at_the_easy_end(row):
    reading = row.read(ir.methods.PathTracing(spp=4), row.easy)
    assert reading.error < row.tolerance
    assert reading.truth.shape == reading.image.shape


def test_the_wall_that_hides_sky_is_the_infinite_ones_limit():
    assert sky_share("wall", 0.001) == pytest.approx((1 + np.sqrt(0.5)) / 2, abs=1e-5)  # row 11 of the closed forms
    assert sky_share("sphere", 0.1) == 0.75


class Broken(ir.methods.ConstantAmbient):
    def compose(self, view, profile):
        direct, indirect, *_ = super().compose(view, profile)
        return direct, np.where(direct > 0, np.nan, indirect).astype(np.float32)


@names("name", ["leak through a thin wall", "black surfaces", "flicker under rotation", "scene scaled up"])
def test_numbers_that_are_not_finite_are_an_infinite_error(name):
    row = dataclasses.replace(ROWS[name], size=(16, 12))
    reading = row.read(Broken(), row.at(0.3))
    assert reading.error == np.inf and np.isfinite(reading.image).all()
