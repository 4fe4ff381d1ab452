"""Attribution: errors that were put into one stage are found there, in the size they have."""

import numpy as np
import pytest
from attribution_fakes import Planted, Tint, Tinted
from study_fakes import Scene

import interreflect as ir
from interreflect import _core
from interreflect.study.attribution import (
    EXACT,
    FAILED,
    FIXED,
    LEFT_OUT,
    MORE_SAMPLES,
    NO_COUNTERPART,
    NO_EFFECT,
    REPLACED,
    attribute,
    counterpart_of,
)
from interreflect.study.reference import Reference

# Importing the fakes made their stages known, as workers need it; here only the tests of this file shall see them.
TINTS = {stage: _core.stages.pop(stage) for stage in ("first_tint", "second_tint")}


@pytest.fixture(autouse=True)
def tints(monkeypatch):
    for stage, entry in TINTS.items():
        monkeypatch.setitem(_core.stages, stage, entry)

SIZE = (24, 16)
GOOD = Reference(noise=1e-5, max_spp=4096)


def tinted(folder, **changes):
    return attribute(Tinted(**changes), Scene(), size=SIZE, reference=GOOD, folder=folder)


def test_errors_that_add_up_are_split_as_they_were_made(fake_truth, tmp_path):
    found = tinted(tmp_path / "a")
    assert [(stage.stage, stage.status) for stage in found.stages if stage.status != FIXED] == [
        ("first_tint", REPLACED),
        ("second_tint", REPLACED),
    ]
    shares = {stage.stage: stage for stage in found.stages}
    # relMSE of a factor 1 + e is e^2 but for epsilon, which hardly differs between the halves: .09 to .01
    assert shares["first_tint"].error == pytest.approx(0.9, abs=0.01)
    assert shares["second_tint"].error == pytest.approx(0.1, abs=0.01)
    assert found.rest == pytest.approx(0, abs=0.01)
    assert found.interaction == pytest.approx(0, abs=1e-9)
    assert sum(stage.error for stage in found.stages if stage.status == REPLACED) + found.rest + found.interaction == pytest.approx(1)
    assert [stage.stage for stage in found.ranking] == ["first_tint", "second_tint"]


def test_an_exact_stage_with_few_samples_is_charged_with_its_noise_and_the_counterparts_own_noise_with_none(fake_truth, tmp_path):
    from attribution_fakes import ExactTint

    noisy = ExactTint(deviation=0.4, samples=4)  # relMSE .04 where it is, .01 of it left by 16 times the samples
    found = attribute(
        Tinted(first_tint=noisy, second_tint=Tint(error=0.1)), Scene(), size=(48, 32), samples=64, reference=GOOD, folder=tmp_path / "a"
    )
    shares = {stage.stage: stage for stage in found.stages}
    assert shares["first_tint"].status == MORE_SAMPLES
    # .04 of .04 + .01, with the 1/16 of it that the 64 samples leave; 2304 independent values a seed know a variance to 3 %,
    # four seeds to 1.5 %
    assert shares["first_tint"].error == pytest.approx(0.8, abs=0.03)
    assert found.noise / found.error == pytest.approx(0.8, abs=0.03)
    assert found.exact_noise == pytest.approx(0.8 / 16, abs=0.01)
    assert shares["second_tint"].error == pytest.approx(0.2, abs=0.03)


def test_a_stage_that_is_left_out_costs_what_it_would_have_given(fake_truth, tmp_path):
    found = tinted(tmp_path / "a", second_tint=None)
    share = {stage.stage: stage for stage in found.stages}["second_tint"]
    assert share.status == LEFT_OUT
    assert share.error == pytest.approx(1 / 1.09, abs=0.01)  # all of its half's light against .3^2 of the other's


def test_a_counterpart_that_fails_among_the_others_is_a_row_that_says_so(fake_truth, tmp_path):
    found = tinted(tmp_path / "a", crowded=True)
    for stage in found.stages:  # of two stages, the first one alone is all but the second one as well
        if stage.stage in ("first_tint", "second_tint"):
            assert stage.status == FAILED and "too crowded" in stage.note and np.isnan(stage.error)
    assert found.rest == pytest.approx(0, abs=0.01)
    assert found.interaction == pytest.approx(1, abs=0.01)
    assert found.ranking == ()
    assert found.error == pytest.approx(tinted(tmp_path / "b").error)
    assert "too crowded" in str(found.table["note"].tolist())
    assert len(found.chart().axes) == 2 and len(found.images().axes) == 3 + 1


def test_an_attribution_resumes_without_rendering(fake_truth, tmp_path, monkeypatch):
    first = tinted(tmp_path / "a")
    monkeypatch.setattr(Tinted, "prepare", None)
    assert tinted(tmp_path / "a").table.equals(first.table)


def test_attribution_needs_two_seeds_to_tell_noise_from_error(fake_truth, tmp_path):
    with pytest.raises(ValueError, match="at least two seeds"):
        attribute(Tinted(), Scene(), size=SIZE, seeds=[0], folder=tmp_path)


def test_every_stage_knows_how_exact_it_is():
    assert counterpart_of("march", ir.DiffuseCones(), 32) == (REPLACED, ir.TracedRays(samples=32))
    assert counterpart_of("shadow", ir.TracedShadows(samples=4), 32) == (MORE_SAMPLES, ir.TracedShadows(samples=32))
    assert counterpart_of("shadow", ir.TracedShadows(samples=64), 32) == (EXACT, None)
    assert counterpart_of("fill", ir.ConeFill(resolution=4), 32) == (REPLACED, ir.TracedFill(resolution=4, samples=2))
    assert counterpart_of("fill", ir.TracedFill(resolution=4, samples=1), 32) == (MORE_SAMPLES, ir.TracedFill(resolution=4, samples=2))
    assert counterpart_of("link", ir.ShLinks(bands=7, near_rays=0), 32) == (REPLACED, ir.AllSurfels(bands=7, samples=32))
    assert counterpart_of("share", ir.EveryPixel(), 32) == (EXACT, None)
    assert counterpart_of("glossy", None, 32) == (LEFT_OUT, ir.TracedRays(samples=32))
    assert counterpart_of("prefilter", ir.SurfaceCoverage(), 32) == (NO_COUNTERPART, None)
    assert counterpart_of("grid", ir.Grid(), 32) == (NO_COUNTERPART, None)


@pytest.mark.parametrize("fault", ["march", "shadow"])
def test_a_fault_planted_in_one_stage_of_a_real_method_is_found_there(fault, tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    # The other stages are exact already, or all but: cones see a box without texture or glossy surfaces well.
    exact = {"voxelize": ir.ExactOverlap(samples=16), "light_voxels": ir.TracedLighting(samples=16), "share": ir.EveryPixel()}
    method = Planted(fault=fault, grid=ir.Grid(resolution=32), shadow=ir.ShadowMap(size=256), **exact)
    scene, truth = ir.scenes.cornell_box(light="point"), Reference(noise=5e-3, max_spp=256)
    found = attribute(method, scene, size=(24, 18), seeds=range(3), samples=16, reference=truth, folder=tmp_path / "a")
    assert found.ranking[0].stage == fault
    cost = {stage.stage: stage.error * found.error for stage in found.stages if np.isfinite(stage.error)}
    # Twice the light of the truth has an error of 1 on the share of the pixels that it dominates.
    assert cost.pop(fault) > 0.2 > 3 * max(cost.values())
    listed = [stage.stage for stage in found.stages]
    assert listed.index("grid") < listed.index("voxelize") and {"gbuffer", "shade", "share"} <= set(listed)
    assert {s.stage: s.note for s in found.stages}["sky"] == NO_EFFECT  # a closed box has none
    assert len(found.chart().axes) == 2
    assert len(found.images().axes) == 3 + len(found.ranking) + sum(bool(s.note) for s in found.stages) + 1


@pytest.fixture
def box(tmp_path, monkeypatch):
    """Attribution on a small Cornell box, whose truth has a hundredth of the noise of two paths."""
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    scene, truth = ir.scenes.cornell_box(), Reference(1e-3, 1024)
    return lambda method, samples: attribute(method, scene, size=(24, 18), samples=samples, reference=truth, folder=tmp_path / "a")


def test_all_the_error_of_path_tracing_is_its_own_samplings(box):
    found = box(ir.methods.PathTracing(spp=2), 16)
    (stage,) = found.stages
    assert (stage.stage, stage.status, stage.counterpart) == ("path_trace", MORE_SAMPLES, "path-tracing")  # spp=16 is the default
    # The eighth of its noise that the counterpart has is charged too; eight frames of 432 pixels know a variance to some 10 %
    assert stage.error == pytest.approx(1, abs=0.2) and not stage.note
    assert found.rest == pytest.approx(0, abs=0.1) and found.interaction == pytest.approx(0, abs=0.2)
    assert found.noise == pytest.approx(found.error, rel=0.3)  # an unbiased estimate errs by noise alone
    (stage,) = box(ir.methods.PathTracing(spp=16), 16).stages
    assert stage.status == EXACT


def test_denoised_path_tracing_is_charged_with_its_noise_and_the_denoisers_bias(box):
    pytest.importorskip("pyoidn")
    found = box(ir.methods.PathTracingDenoised(), 64)
    shares = {stage.stage: stage for stage in found.stages if stage.status in (REPLACED, MORE_SAMPLES)}
    assert shares["path_trace"].counterpart == "path-tracing-denoised spp=64"
    assert shares["denoise"].counterpart == "path-tracing spp=1, pattern=8"
    assert all(share.error > 0.05 for share in shares.values())
    # Without both it is unbiased path tracing, which has nothing but noise.
    assert found.rest == pytest.approx(0, abs=0.05)
    assert sum(share.error for share in shares.values()) + found.rest + found.interaction == pytest.approx(1)


def test_illuminance_composition_is_charged_with_its_caches_links_and_bands(box):
    method = ir.methods.IlluminanceComposition(
        place_surfels=ir.HaltonSurfels(surfels=1000), place_caches=ir.CacheGrid(nx=4, ny=4, nz=4), link=ir.ShLinks(links=16, bands=2)
    )
    found = {stage.stage: stage for stage in box(method, 256).stages}
    counterparts = {name: found[name].counterpart.partition("(")[0] for name in ("place_caches", "link", "evaluate")}
    assert counterparts == {"place_caches": "PixelCaches", "link": "AllSurfels", "evaluate": "DirectLinks"}
    assert all(found[name].status == REPLACED for name in counterparts)
    assert found["place_surfels"].status == found["cluster_surfels"].status == NO_COUNTERPART
    # Sixteen caches a wall, two bands and sixteen links: each is far from enough.
    assert found["place_caches"].error > 0.2 and found["link"].error + found["evaluate"].error > 0.1


def test_what_sharing_is_charged_with_does_not_depend_on_the_counterparts_rays(box):
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16))
    few, many = ({stage.stage: stage for stage in box(method, samples).stages}["share"] for samples in (16, 64))
    # Where rays take the cones' place, sharing them makes more noise than the method itself has error: 1.5 of it for 16 rays.
    assert few.low <= many.error <= few.high
    assert few.error < 0.4 and many.error < 0.4


def test_without_denoising_the_same_paths_are_left():
    pytest.importorskip("pyoidn")
    method, scene = ir.methods.PathTracingDenoised(spp=2, bounces=1), ir.scenes.cornell_box()
    denoised = method.render(scene, size=SIZE, seed=3)
    plain = method.exactly(["denoise"], 128)
    assert isinstance(plain, ir.methods.PathTracing) and plain.spp == 2
    traced = plain.render(scene, size=SIZE, seed=3)
    paths = [frame.profile.stages["path_trace"].counts for frame in (denoised, traced)]
    assert paths[0] == paths[1]  # rays depend on every random number
