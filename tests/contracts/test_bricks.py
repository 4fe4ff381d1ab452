"""Levels in bricks hold the same texels as dense ones, bit for bit, in memory that follows what is not air."""

from __future__ import annotations

import numpy as np
import pytest
from test_prefilter import VARIANTS, lit_soup
from voxel_scenes import floor, scene_of

import interreflect as ir
from interreflect import _core

FILTERS = (*(t() for t in _core.stages["prefilter"]["techniques"]), *VARIANTS)
DENSE, BRICKS = 131072, 0


def in_both(technique, lit):
    return [ir.prefilter(technique.replace(dense_limit=limit), lit) for limit in (DENSE, BRICKS)]


@pytest.mark.parametrize("technique", FILTERS, ids=repr)
@pytest.mark.parametrize("cells", [[32, 32, 32], [33, 20, 47], [3, 7, 40], [64, 9, 1]])
def test_bricks_hold_the_texels_of_dense_levels(technique, cells):
    dense, bricks = in_both(technique, lit_soup(cells))
    assert dense.levels == bricks.levels and dense.scale == bricks.scale
    for i in range(dense.levels):
        for face in range(dense.faces):
            assert dense.level(i, face).tobytes() == bricks.level(i, face).tobytes()


WARPS = (ir.Linear(), ir.CubicSpline(), ir.Logistic(), ir.Perspective(), ir.Spherical())


@pytest.mark.parametrize("technique", [t() for t in _core.stages["prefilter"]["techniques"]], ids=repr)
@pytest.mark.parametrize("warp", WARPS, ids=lambda w: type(w).__name__)
def test_cones_see_the_same_bits_in_bricks_as_in_dense_levels(technique, warp):
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=21, warp=warp), march=ir.DiffuseCones(cones=9))
    scene = ir.scenes.cornell_box()
    dense, bricks = (
        method.replace(prefilter=technique.replace(dense_limit=limit)).render(scene, size=(24, 16), seed=3).indirect
        for limit in (DENSE, BRICKS)
    )
    assert dense.max() > 0 and np.array_equal(dense, bricks)


def test_rays_look_up_the_same_voxels_in_bricks():
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=21), march=ir.TracedRays())
    scene = ir.scenes.cornell_box()
    dense, bricks = (
        method.replace(prefilter=ir.OctantCoverage(dense_limit=limit)).render(scene, size=(24, 16), seed=3).indirect
        for limit in (DENSE, BRICKS)
    )
    assert dense.max() > 0 and np.array_equal(dense, bricks)


def test_bricks_have_the_same_bits_at_one_and_two_threads():
    lit = lit_soup([33, 20, 47])
    results = []
    for threads in (1, 2):
        with _core.Threads(threads):
            results.append(ir.prefilter(ir.OctantCoverage(dense_limit=BRICKS), lit))
    for i in range(results[0].levels):
        assert results[0].level(i, 5).tobytes() == results[1].level(i, 5).tobytes()


def test_memory_of_bricks_follows_the_surface_and_not_the_volume():
    scene = scene_of(floor())
    sizes = {}
    for n in (64, 128):
        voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.Domain(lower=[-1.01] * 3, voxel_size=2.02 / n, cells=[n] * 3))
        lit = ir.light_voxels(ir.TracedLighting(), scene, voxels, 0)
        sizes[n] = [pyramid.bytes / len(voxels) for pyramid in in_both(ir.OctantCoverage(), lit)]
    # A plane has 4 times the voxels at twice the resolution; a volume, 8 times.
    assert sizes[128][0] / sizes[64][0] == pytest.approx(2, rel=0.1)
    assert sizes[128][1] / sizes[64][1] == pytest.approx(1, rel=0.2)
    assert sizes[128][1] < 0.05 * sizes[128][0]


def test_a_level_goes_into_bricks_where_it_would_be_too_large():
    lit = lit_soup([64, 64, 64])  # 2.2 MiB for the finest of one volume
    dense, none = (ir.prefilter(ir.SurfaceCoverage(dense_limit=limit), lit).bytes for limit in (3, DENSE))
    some, all_ = (ir.prefilter(ir.SurfaceCoverage(dense_limit=limit), lit).bytes for limit in (2, BRICKS))
    assert dense == none and some < dense and all_ < dense
