"""What the knobs of filters do: levels, kernel, format."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from voxel_scenes import box, floor, scene_of, soup

import interreflect as ir
from interreflect import _core

SUN = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(np.pi,) * 3)
FILTERS = _core.stages["prefilter"]["techniques"]
ISOTROPIC = (ir.VolumeCoverage, ir.SurfaceCoverage)


def lit_soup(cells, irradiance=np.pi):
    sun = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(irradiance, irradiance / 2, irradiance / 4))
    scene = scene_of(*soup(6), floor(), lights=[sun])
    low, high = np.asarray(scene.bounds)
    size = float((high - low).max() / (max(cells) - 1))
    domain = _core.Domain(lower=[float(v) for v in low - 0.5 * size], voxel_size=size, cells=cells)
    return ir.light_voxels(ir.TracedLighting(both_sides=True), scene, ir.voxelize(ir.SurfaceSampling(), scene, domain), 0)


@pytest.mark.parametrize("technique", FILTERS)
def test_fewer_levels_are_the_first_of_all_levels(technique):
    lit = lit_soup([32, 32, 32])
    every = ir.prefilter(technique(), lit)
    assert every.levels == 6
    for count in (1, 2, 4, 6, 11):
        few = ir.prefilter(technique(levels=count), lit)
        assert few.levels == min(count, 6) and few.bytes <= every.bytes
        for i in range(few.levels):
            for face in range(few.faces):
                assert np.array_equal(few.level(i, face), every.level(i, face))


@pytest.mark.parametrize("technique", FILTERS)
@pytest.mark.parametrize("levels", [1, 3])
def test_cones_march_a_pyramid_of_few_levels_and_see_the_light_of_all(technique, levels):
    scene = ir.scenes.cornell_box()
    method = ir.methods.VoxelConeTracing(prefilter=technique(), grid=ir.Grid(resolution=32))
    every = method.prepare(scene).render(size=(32, 32)).indirect.mean()
    few = method.replace(prefilter=technique(levels=levels)).prepare(scene).render(size=(32, 32)).indirect.mean()
    # Wide cones then see thin samples of the room instead of means: noisier, and fainter where volumes had thinned the walls.
    assert few == pytest.approx(every, rel=0.5) and few > 0


def test_the_tent_weighs_four_texels_an_axis_by_1_3_3_1():
    # One voxel alone in the middle of 8: its weight in the two texels of the next level on either side, along each axis.
    box_ = ir.Material(albedo=(0.5,) * 3)
    speck = box((3.2, 3.2, 3.2), (3.8, 3.8, 3.8), material=box_)
    domain = _core.Domain(lower=[0.0] * 3, voxel_size=1.0, cells=[8] * 3)
    scene = scene_of(speck, lights=[SUN])
    lit = ir.light_voxels(ir.TracedLighting(), scene, ir.voxelize(ir.ExactOverlap(), scene, domain), 0)
    assert len(lit.voxels) == 1
    along = np.array([0, 3, 1, 0]) / 8  # voxel 3: the second of texel 1's own, the one before texel 2's
    weight = along[:, None, None] * along[:, None] * along
    seen = ir.prefilter(ir.VolumeCoverage(kernel="tent"), lit).level(1)[..., 3]
    assert np.allclose(seen, weight, rtol=2**-11)
    seen = ir.prefilter(ir.SurfaceCoverage(kernel="tent"), lit).level(1)[..., 3]
    assert np.allclose(seen, 2 * weight, rtol=2**-11)


@pytest.mark.parametrize("kernel", ["box", "tent"])
@pytest.mark.parametrize("cells", [[32, 32, 32], [32, 16, 8], [21, 32, 13]])
def test_volume_coverage_keeps_the_energy_of_the_volume_with_either_kernel(kernel, cells):
    pyramid = ir.prefilter(ir.VolumeCoverage(kernel=kernel), lit_soup(cells))
    sums = [pyramid.level(i).astype(np.float64).sum((0, 1, 2)) * 8**i for i in range(pyramid.levels)]
    for total in sums[1:]:
        assert np.allclose(total, sums[0], rtol=2e-3)  # a rounding of 2^-11 a level


@pytest.mark.parametrize("technique", ISOTROPIC)
@pytest.mark.parametrize("kernel", ["box", "tent"])
def test_a_solid_block_of_light_looks_the_same_at_every_level_and_up_to_its_edge(technique, kernel):
    sheets = [floor(height=(i + 0.5) / 8 - 1, albedo=(0.5,) * 3) for i in range(16)]
    domain = _core.Domain(lower=[-1.0] * 3, voxel_size=1 / 8, cells=[16] * 3)
    scene = scene_of(*sheets, lights=[ir.DirectionalLight(direction=(0, -1, 0), irradiance=(np.pi,) * 3)])
    lit = ir.light_voxels(ir.TracedLighting(), scene, ir.voxelize(ir.ExactOverlap(), scene, domain), 0)
    assert len(lit.voxels) == 16**3
    pyramid = ir.prefilter(technique(kernel=kernel), lit)
    total = pyramid.level(0)[..., :3].mean()
    for i in range(pyramid.levels):
        assert (pyramid.level(i)[..., 3] == 1).all()
        assert pyramid.level(i)[..., :3].mean() == pytest.approx(total, rel=5e-3)  # a rounding of 2^-11 a level


@pytest.mark.parametrize("technique", ISOTROPIC)
@pytest.mark.parametrize("kernel", ["box", "tent"])
def test_eight_bits_hold_multiples_of_1_255_and_clip_at_a_radiance_of_1(technique, kernel):
    plain, bytes_ = technique(kernel=kernel), technique(kernel=kernel, format="rgba8")
    dim = lit_soup([24, 24, 24])
    assert 0.4 < dim.radiance.max() < 1
    wide, narrow = ir.prefilter(plain, dim), ir.prefilter(bytes_, dim)
    assert narrow.scale == 1
    for i in range(wide.levels):
        texels = narrow.level(i) * 255
        assert np.allclose(texels, np.round(texels), atol=255 * 2**-12)  # the half float nearest to n / 255
        # Half a step a level; a clamped sum of eight quarters adds up to twice the roundings below it.
        assert np.abs(narrow.level(i) - wide.level(i)).max() < 0.5 / 255 * 2 ** (i + 1)
    bright = ir.prefilter(bytes_, lit_soup([24, 24, 24], irradiance=np.pi * 100))
    assert bright.level(0)[..., :3].max() == 1 and wide.level(0)[..., :3].max() < 1
    for i in range(bright.levels):
        assert (bright.level(i)[..., :3].max(-1) <= bright.level(i)[..., 3] + 1 / 255).all()


def test_clipping_darkens_a_bright_room_and_leaves_a_dim_one_alone():
    room = ir.scenes.cornell_box("point")
    lamp = room.lights[0]

    def gain(technique, factor):
        """Indirect light over that of half floats, with a lamp `factor` times as bright."""
        scene = room.replace(lights=[dataclasses.replace(lamp, intensity=tuple(factor * v for v in lamp.intensity))])
        method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=32))
        means = [
            method.replace(prefilter=t).prepare(scene).render(size=(32, 32)).indirect.mean()
            for t in (technique(), technique(format="rgba8"))
        ]
        return means[1] / means[0]

    lit = lit_room(room)
    dim, bright = 1 / lit.radiance.max(), 8 / lit.radiance.max()
    kept = np.minimum(lit.radiance * bright, 1).sum() / (lit.radiance * bright).sum()
    assert kept < 0.9
    for technique in ISOTROPIC:
        # Volume coverage halves a wall's values from level to level, below half a step of 1/255 in the coarsest: some light is lost.
        assert gain(technique, dim) == pytest.approx(1, abs=0.1)
        assert gain(technique, bright) < 0.5 + kept / 2


def lit_room(scene):
    method = ir.methods.VoxelConeTracing()
    voxels = ir.voxelize(method.voxelize, scene, ir.Grid(resolution=32).place(scene))
    return ir.light_voxels(method.light_voxels, scene, voxels, 0)


COLUMNS = (ir.SurfaceCoverage(opacity="columns"), ir.OctantCoverage(opacity="columns"), ir.SphericalHarmonicVoxels(opacity="columns"))


def blocked_columns(alpha):
    """What `columns` says of a level of sizes that are even: the cross-section's blocked share, of the axis that sees most."""
    wide = np.pad(alpha.astype(np.float64), 1, mode="edge")  # the border repeats the outermost texels
    shares = []
    for axis in range(3):
        view = np.moveaxis(wide, axis, 0)
        clear = [np.prod([1 - view[2 * i + k] for k in range(4)], axis=0)[1:-1, 1:-1] for i in range(alpha.shape[axis] // 2)]
        open_ = np.stack(clear)
        means = open_.reshape(len(open_), open_.shape[1] // 2, 2, open_.shape[2] // 2, 2).mean((2, 4))
        shares.append(np.moveaxis(1 - means, 0, axis))
    return np.max(shares, axis=0)


@pytest.mark.parametrize("technique", COLUMNS, ids=lambda t: type(t).__name__)
def test_columns_block_the_share_of_a_cross_section_that_the_numeric_sum_says(technique):
    pyramid = ir.prefilter(technique, lit_soup([32, 16, 24]))
    for i in range(3):
        fine, coarse = pyramid.level(i)[..., 3], pyramid.level(i + 1)[..., 3]
        z, y, x = coarse.shape
        own = fine.reshape(z, 2, y, 2, x, 2).max((1, 3, 5)) > 0  # a texel without a surface stays air
        assert np.allclose(coarse, np.where(own, blocked_columns(fine), 0), atol=2**-11)


@pytest.mark.parametrize("technique", COLUMNS, ids=lambda t: type(t).__name__)
def test_slanted_walls_stay_more_closed_with_columns_than_with_sums(technique):
    # Inside a closed sphere nothing of the sky is seen.
    sphere = ir.scenes.furnace(shape="sphere", albedo=0.5)
    scene = ir.Scene(meshes=sphere.meshes, cameras={"centre": ir.Camera(position=(0, 0, 0), target=(1, 0.2, 0.1), fov_x=60)})
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=64).place(scene))
    lit = ir.light_voxels(ir.TracedLighting(both_sides=True), scene, voxels, 0)
    gbuffer = ir.trace_gbuffer(scene, "centre", (16, 16))
    leaks = [
        1 - ir.march(ir.DiffuseCones(), ir.prefilter(t, lit), gbuffer, scene, seed=1).occlusion.mean()
        for t in (technique, technique.replace(opacity="sum"))
    ]
    assert leaks[0] < 0.03 < 0.06 < leaks[1]  # by choice; a third of the quarter sums' leak


VARIANTS = (
    *COLUMNS,
    ir.SurfaceCoverage(opacity="columns", kernel="tent", format="rgba8", levels=4),
    *(t(kernel="tent") for t in ISOTROPIC),
    *(t(format="rgba8") for t in ISOTROPIC),
)


@pytest.mark.parametrize("technique", VARIANTS, ids=repr)
def test_every_variant_has_the_same_bits_at_one_and_two_threads_and_no_light_without_light(technique):
    lit = lit_soup([33, 20, 47])
    results = []
    for threads in (1, 2):
        with _core.Threads(threads):
            results.append(ir.prefilter(technique, lit))
    for i in range(results[0].levels):
        for face in range(results[0].faces):
            one, two = (p.level(i, face) for p in results)
            assert np.array_equal(one, two) and np.isfinite(one).all()
            assert one[..., 3].min() >= 0 and one[..., 3].max() <= 1
            assert not one[..., :3][results[0].level(i)[..., 3] == 0].any()
