"""Grids of caches: where pixels look into them, and several over each other, of which pixels read the finest that reaches them."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import interreflect as ir
from interreflect import stages
from interreflect.scenes.builtin.cornell_box import cornell_box

SIZE = (64, 48)
FINE = ir.CacheGrid(nx=12, ny=12, nz=12)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=512), place_caches=FINE, link=ir.ShLinks(links=64, near_rays=64),
)  # fmt: skip


@cache
def drawn(**grid):
    return METHOD.replace(place_caches=FINE.replace(**grid)).render(cornell_box(), size=SIZE)


def indirect(**grid):
    return np.asarray(drawn(**grid).indirect)


def test_a_look_before_the_surface_counts_caches_behind_it_less():
    truth = np.asarray(ir.reference(cornell_box(), size=SIZE, bounces=1, noise=1e-2, max_spp=128).indirect)
    way = METHOD.replace({"place_surfels.surfels": 4096, "link.links": 254})
    grids = [FINE.replace(ny=8, normal_offset=offset) for offset in (0.0, 0.25)]
    drawn_by = [np.asarray(way.replace(place_caches=grid).render(cornell_box(), size=SIZE).indirect) for grid in grids]
    on_it, before_it = (ir.metrics.relmse(image, truth) for image in drawn_by)
    assert before_it < 0.7 * on_it, (before_it, on_it)


def test_all_within_reach_reads_the_finest_level():
    # Links' unit is that of all caches, so the last bits differ.
    assert np.allclose(indirect(levels=3, reach=1000), indirect(), rtol=1e-4, atol=1e-5 * indirect().max())


def test_all_beyond_reach_reads_the_coarsest_level():
    single = indirect(nx=6, ny=6, nz=6)
    assert np.allclose(indirect(levels=2, reach=0.1), single, rtol=1e-4, atol=1e-5 * single.max())


def reach_to_the_middle():
    """So that the finest level fades out about what lies at the middle distance."""
    scene = cornell_box()
    gbuffer = ir.trace_gbuffer(scene, scene.cameras[next(iter(scene.cameras))], SIZE)
    lower, upper = np.asarray(scene.bounds)
    depth = np.asarray(gbuffer.depth)
    return float(np.median(depth[np.isfinite(depth)]) / 0.9 / ((upper - lower).max() / 12))


def test_odd_sides_are_rounded_up():
    sites = stages.place_caches(ir.CacheGrid(nx=5, ny=3, nz=1, most_backs=1, levels=4), cornell_box())
    assert len(sites) == 5 * 3 * 1 + 3 * 2 * 1 + 2 * 1 * 1 + 1


def test_levels_meet_without_a_step():
    """Along a line through the end of the finest level's reach no pixel's light changes by more than in the coarse grid alone."""
    between = indirect(levels=2, reach=reach_to_the_middle())
    fine, coarse = indirect(), indirect(nx=6, ny=6, nz=6)
    lower, upper = np.minimum(fine, coarse), np.maximum(fine, coarse)
    slack = 1e-4 * upper.max()
    assert ((between >= lower - slack) & (between <= upper + slack)).all()
    assert (np.abs(between - fine) > 10 * slack).any() and (np.abs(between - coarse) > 10 * slack).any()

    def steepest(image):
        return np.abs(np.diff(image, axis=1)).max()

    assert steepest(between) <= 1.5 * max(steepest(fine), steepest(coarse))


def test_far_levels_spare_caches_that_are_lit():
    read = METHOD.replace(lit_caches="read", place_caches=FINE.replace(levels=3, reach=0.5 * reach_to_the_middle()))
    lit = read.render(cornell_box(), size=SIZE).profile.stages["light_caches"].counts["links"]
    finest = METHOD.replace(lit_caches="read").render(cornell_box(), size=SIZE).profile.stages["light_caches"].counts["links"]
    assert 0 < lit < 0.5 * finest


def test_levels_are_kept_in_files(tmp_path):
    method = METHOD.replace(place_caches=FINE.replace(levels=2, reach=reach_to_the_middle()))
    prepared = method.prepare(cornell_box())
    prepared.save(tmp_path / "levels")
    again = method.load(tmp_path / "levels", cornell_box())
    assert np.array_equal(again.render(size=SIZE).image, prepared.render(size=SIZE).image)


def test_several_bounces_read_the_coarsest_level_at_surfels():
    method = METHOD.replace(place_caches=FINE.replace(levels=2, reach=reach_to_the_middle()), bounces=3)
    one, three = indirect(levels=2, reach=reach_to_the_middle()).sum(), np.asarray(method.render(cornell_box(), size=SIZE).indirect).sum()
    single = np.asarray(METHOD.replace(bounces=3).render(cornell_box(), size=SIZE).indirect).sum() / indirect().sum()
    assert three / one == pytest.approx(single, rel=0.05)


@pytest.mark.parametrize(("grid", "message"), [({"levels": 0}, "levels must lie in"), ({"levels": 9}, "levels must lie in"),
                                               ({"reach": 0.0}, "reach must lie in")])  # fmt: skip
def test_bad_levels_are_value_errors(grid, message):
    with pytest.raises(ValueError, match=message):
        FINE.replace(**grid)
