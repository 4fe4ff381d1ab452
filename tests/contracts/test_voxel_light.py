"""What every technique of `light_voxels` and `prefilter` owes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from voxel_scenes import QUAD, box, floor, mapped, quad, scaled, scene_of, soup

import interreflect as ir
from interreflect import _core

SUN = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(np.pi,) * 3)


@pytest.fixture(params=_core.stages["light_voxels"]["techniques"], ids=lambda cls: cls.__name__)
def lighting(request):
    return request.param()


@pytest.fixture(params=_core.stages["prefilter"]["techniques"], ids=lambda cls: cls.__name__)
def coverage(request):
    return request.param()


def sampled(technique, samples):
    """The technique, or what it holds, with as many samples."""
    if hasattr(technique, "light_voxels"):
        return technique.replace(light_voxels=sampled(technique.light_voxels, samples))
    return technique.replace(samples=samples)


def by_cones(technique):
    return isinstance(technique, ir.ConeLighting)


def lit_of(technique, scene, resolution=16, seed=0, domain=None, voxelize=None):
    voxels = ir.voxelize(voxelize or ir.SurfaceSampling(), scene, domain or ir.Grid(resolution=resolution).place(scene))
    return ir.light_voxels(technique, scene, voxels, seed)


def room(lights, **material):
    return scene_of(box((-2, 0, -2), (2, 3, 2), inward=True, material=ir.Material(**material)), *soup(1, 20), lights=lights)


LIGHTS = {
    "sun": ir.DirectionalLight(direction=(0.2, -1, 0.1), irradiance=(3, 2, 1)),
    "point": ir.PointLight(position=(0.3, 1.1, -0.2), intensity=(2, 3, 4)),
    "spot": ir.SpotLight(position=(-1, 2.5, 1), direction=(0.4, -1, -0.3), intensity=(9, 8, 7), inner=20, outer=35),
    "sky": ir.EnvironmentLight(radiance=(0.5, 0.6, 0.9)),
    "map": ir.EnvironmentLight(image=np.random.default_rng(0).uniform(0, 2, (4, 8, 3)).astype(np.float32)),
}


@pytest.mark.parametrize("light", LIGHTS)
def test_radiance_is_linear_in_the_light(lighting, light):
    value = LIGHTS[light]
    key = {"sun": "irradiance", "sky": "radiance", "map": "radiance"}.get(light, "intensity")
    brighter = dataclasses.replace(value, **{key: tuple(4 * v for v in getattr(value, key))})
    scene = room([value]) if light not in ("sky", "map", "sun") else scene_of(*soup(2, 40), lights=[value])
    once, four = lit_of(lighting, scene), lit_of(lighting, scene.replace(lights=[brighter]))
    assert once.radiance.max() > 0 and np.array_equal(4 * once.radiance, four.radiance)


def test_lights_add_up_and_no_light_is_black(lighting):
    lights = [LIGHTS["point"], LIGHTS["spot"], LIGHTS["sky"]]
    scene = room(lights)
    apart = sum(lit_of(lighting, scene.replace(lights=[light])).radiance for light in lights)
    assert np.allclose(lit_of(lighting, scene).radiance, apart, rtol=1e-5, atol=1e-6)
    assert not lit_of(lighting, scene.replace(lights=[])).radiance.any()


def test_a_floor_reflects_albedo_over_pi_times_irradiance(lighting):
    tilted = ir.DirectionalLight(direction=(np.sqrt(3), -1, 0), irradiance=(np.pi, 1, 2))
    lit = lit_of(lighting, scene_of(floor(albedo=(0.5, 0.4, 0.2)), lights=[tilted]))
    # 60 degrees from the normal: cosine 1/2.
    assert np.allclose(lit.radiance, (0.25, 0.2 / np.pi, 0.2 / np.pi), rtol=1e-4)
    # An open floor sees the sky's half: irradiance pi L whatever the sample, since directions are drawn by cosine.
    sky = scene_of(floor(albedo=(0.5,) * 3), lights=[ir.EnvironmentLight(radiance=(1, 2, 3))])
    assert np.allclose(lit_of(lighting, sky).radiance, (0.5, 1, 1.5), rtol=1e-5)


def test_a_point_light_in_a_sphere_lights_every_voxel_alike(lighting):
    # GROUND_TRUTH 3: rho = 1/2, intensity pi, R = 1: direct radiance 1/2. A voxel of 1/16 stands for a polygon's face, off the
    # sphere by 1 - cos(180 / 64 degrees) = 0.1 %.
    scene = ir.scenes.furnace(shape="sphere", albedo=0.5)
    meshes = [mesh.replace(material=ir.Material(albedo=(0.5,) * 3)) for mesh in scene.meshes]
    radius = np.abs(scene.bounds).max()
    lit = lit_of(lighting, ir.Scene(meshes=meshes, lights=[ir.PointLight(position=(0, 0, 0), intensity=(np.pi * radius**2,) * 3)]), 32)
    # Cones about the light's direction are as wide as the sphere's own voxels where they start: these take a few per cent.
    assert np.allclose(lit.radiance, 0.5, rtol=0.1 if by_cones(lighting) else 0.02)
    assert lit.radiance.mean() == pytest.approx(0.5, rel=0.02)


def test_an_emitter_overhead_lights_the_floor_by_its_form_factor(lighting):
    # GROUND_TRUTH 12: a unit square light 1 above the point under its centre: form factor 0.239456.
    lamp = quad([[-0.5, 1, -0.5], [0.5, 1, -0.5], [0.5, 1, 0.5], [-0.5, 1, 0.5]], albedo=(0, 0, 0), emission=(2, 2, 2))
    spot = floor(half=0.01, albedo=(0.5,) * 3)
    scene = scene_of(lamp, spot)
    domain = _core.Domain(lower=[-0.6, -0.15, -0.6], voxel_size=0.08, cells=[15, 15, 15])
    lit = lit_of(sampled(lighting, 1024), scene, domain=domain)
    low = lit.voxels.coordinates[:, 1] < 5
    assert not lit.radiance[~low].any()  # the lamp reflects nothing, and what it emits is kept apart
    assert np.allclose(lit.radiance[low], 0.5 * 2 * 0.239456, rtol=0.01)  # 1024 stratified samples


def test_the_shadow_of_a_roof_is_black_and_exact_at_voxels(lighting):
    scene = scene_of(floor(0, half=2), floor(1, half=1), lights=[SUN])
    lit = lit_of(lighting, scene, 41)
    x, y, z = (lit.voxels.position.T[k] for k in range(3))
    under = (np.abs(x) < 1) & (np.abs(z) < 1) & (y < 0.5)
    edge = (np.abs(np.abs(x) - 1) < 0.1) | (np.abs(np.abs(z) - 1) < 0.1)
    assert not lit.radiance[under & ~edge].any()
    assert np.allclose(lit.radiance[~under & ~edge], 0.5, rtol=1e-5)


def test_the_front_of_a_thin_sheet_is_lit_from_the_front_only():
    sheet = floor(albedo=(0.5,) * 3)
    below = scene_of(sheet, lights=[ir.DirectionalLight(direction=(0, 1, 0), irradiance=(np.pi,) * 3)])
    lit = lit_of(ir.TracedLighting(), below)
    assert not lit.radiance.any() and lit.back.shape == (0, 3)
    lit = lit_of(ir.TracedLighting(both_sides=True), below)
    assert not lit.radiance.any() and np.allclose(lit.back, 0.5, rtol=1e-5)
    one_sided = scene_of(floor(albedo=(0.5,) * 3, two_sided=False), lights=below.lights)
    assert not lit_of(ir.TracedLighting(both_sides=True), one_sided).back.any()


def test_light_of_moved_and_rescaled_scenes_agrees(lighting):
    scene = scene_of(*soup(3, 40))
    domain = ir.Grid(resolution=24).place(scene)
    sun = [LIGHTS["sun"], LIGHTS["sky"]]
    plain = lit_of(lighting, ir.Scene(meshes=scene.meshes, lights=sun), domain=domain)
    for factor, offset in ((8, (0, 0, 0)), (1e3, (0, 0, 0)), (1e-3, (0, 0, 0)), (1, (200, 0, -100))):
        there = _core.Domain(
            lower=[float(v) for v in np.asarray(domain.lower) * factor + offset], voxel_size=domain.voxel_size * factor, cells=domain.cells
        )
        other = lit_of(lighting, mapped(scene, scaled(factor, offset)).replace(lights=sun), domain=there)
        a, b = np.isin(plain.voxels.cell, other.voxels.cell), np.isin(other.voxels.cell, plain.voxels.cell)
        change = np.abs(plain.radiance[a] - other.radiance[b]).max(1)
        # Rays that pass an edge within rounding may change sides, and a voxel whose largest triangle changes its point.
        assert (change > 1e-3).mean() < 0.01


def test_light_has_the_same_bits_at_one_and_two_threads_and_another_seed_has_others(lighting):
    scene = ir.scenes.cornell_box()
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=48).place(scene))
    results = []
    for threads in (1, 2):
        with _core.Threads(threads):
            results.append(ir.light_voxels(lighting, scene, voxels, 5).radiance)
    assert np.array_equal(*results) and results[0].max() > 0
    assert not np.array_equal(results[0], ir.light_voxels(lighting, scene, voxels, 6).radiance)


def test_a_scene_without_triangles_or_lights_or_both_has_voxels_without_light(lighting):
    lights = [LIGHTS["sun"], LIGHTS["point"], LIGHTS["sky"]]
    for scene in (scene_of(lights=lights), scene_of(), scene_of(floor())):
        lit = lit_of(lighting, scene)
        again = ir.light_voxels(lighting, scene, lit.voxels, history=ir.prefilter(ir.SurfaceCoverage(), lit))
        assert len(lit.voxels) == len(again.radiance) and not lit.radiance.any() and not again.radiance.any()


def test_more_samples_converge_to_the_same_light():
    scene = ir.scenes.cornell_box()
    few = np.mean([lit_of(ir.TracedLighting(samples=1), scene, 24, seed).radiance for seed in range(64)], 0)
    many = lit_of(ir.TracedLighting(samples=256), scene, 24, 0).radiance
    # 64 samples of a lamp seen from all over the room: a standard error of about 4 % a voxel, and of 0.1 % for the mean of them all.
    assert abs(few.mean() / many.mean() - 1) < 0.005
    assert np.abs(few - many).mean() < 0.05 * many.mean()


def test_a_uniform_world_stays_uniform(coverage):
    # One sheet through a single layer of voxels: its colour is the same at every level, whatever the opacity.
    scene = scene_of(floor(albedo=(0.5, 0.25, 0.125)), lights=[SUN])
    sides = coverage != ir.SphericalHarmonicVoxels()  # whose first volume is the mean of both sides
    pyramid = ir.prefilter(coverage, lit_of(ir.TracedLighting(both_sides=sides), scene, 32))
    for i in range(pyramid.levels):
        for face in range(1 if pyramid.faces == 4 else pyramid.faces):  # harmonics: test_prefilter.py
            if face & 2 if pyramid.faces == 8 else face == 2:
                continue  # from below one sees the sheet's back, which has no light
            level = pyramid.level(i, face)
            seen = level[..., 3] > 0
            # Half floats: 2^-11 each for radiance and opacity, once a level.
            assert np.allclose(level[seen][:, :3] / level[seen][:, 3:], (0.5, 0.25, 0.125), rtol=0.01)


def test_no_light_in_gives_no_light_out(coverage):
    scene = scene_of(*soup(1), floor())
    pyramid = ir.prefilter(coverage, lit_of(ir.TracedLighting(), scene, 20))
    for i in range(pyramid.levels):
        level = pyramid.level(i)
        assert not level[..., :3].any() and level[..., 3].max() > 0


def test_levels_halve_rounding_up_down_to_one_texel(coverage):
    scene = scene_of(box((0, 0, 0), (36, 4, 10)))
    pyramid = ir.prefilter(coverage, lit_of(ir.TracedLighting(), scene, 37))
    sizes = [pyramid.level(i).shape for i in range(pyramid.levels)]
    assert sizes == [(11, 5, 37, 4), (6, 3, 19, 4), (3, 2, 10, 4), (2, 1, 5, 4), (1, 1, 3, 4), (1, 1, 2, 4), (1, 1, 1, 4)]
    with pytest.raises(IndexError, match="level must lie in"):
        pyramid.level(7)


def test_the_finest_level_holds_every_voxel_in_its_place(coverage):
    lit = lit_of(ir.TracedLighting(), scene_of(*soup(4), lights=[SUN]), 21)
    pyramid, voxels = ir.prefilter(coverage, lit), lit.voxels
    want = np.zeros((*voxels.domain.cells[::-1], 4))
    x, y, z = voxels.coordinates.T
    want[z, y, x] = np.concatenate([lit.radiance * voxels.opacity[:, None], voxels.opacity[:, None]], 1)
    assert np.allclose(pyramid.level(0), want, rtol=2**-11, atol=2**-20)  # half floats


@pytest.mark.parametrize("factor", [2.0**-60, 1e-9, 1e6, 1e30])
def test_radiance_of_any_size_survives_half_floats(coverage, factor):
    lit = lambda e: lit_of(ir.TracedLighting(), scene_of(*soup(5), lights=[dataclasses.replace(SUN, irradiance=(e, e / 2, e / 4))]), 16)  # noqa: E731
    plain, other = ir.prefilter(coverage, lit(1.0)), ir.prefilter(coverage, lit(factor))
    for i in range(plain.levels):
        a, b = plain.level(i).astype(np.float64), other.level(i).astype(np.float64)
        assert np.isfinite(b).all() and np.allclose(a[..., 3], b[..., 3], atol=1e-6)
        # One rounding to half floats a level.
        assert np.allclose(b[..., :3], a[..., :3] * factor, rtol=2**-10 * (i + 1), atol=factor * 1e-6)


def test_volume_coverage_keeps_the_energy_of_the_volume():
    lit = lit_of(ir.TracedLighting(), scene_of(*soup(6), floor(), lights=[SUN]), 32)
    domain = _core.Domain(lower=lit.voxels.domain.lower, voxel_size=lit.voxels.domain.voxel_size, cells=[32, 32, 32])
    lit = lit_of(ir.TracedLighting(), scene_of(*soup(6), floor(), lights=[SUN]), domain=domain)
    pyramid = ir.prefilter(ir.VolumeCoverage(), lit)
    sums = [pyramid.level(i).astype(np.float64).sum((0, 1, 2)) * 8**i for i in range(pyramid.levels)]
    assert len(sums) == 6
    for total in sums[1:]:
        assert np.allclose(total, sums[0], rtol=2e-3)  # a rounding of 2^-11 a level


@pytest.mark.parametrize("axis", range(3))
def test_a_wall_one_voxel_thick_stays_opaque_under_surface_coverage_and_fades_under_volume_coverage(axis):
    wall = floor(height=0.05)
    matrix = np.eye(4)
    matrix[:3, :3] = np.roll(np.eye(3), axis - 1, axis=0)
    scene = scene_of(wall.replace(transform=matrix), lights=[])
    domain = _core.Domain(lower=[-1.0] * 3, voxel_size=1 / 16, cells=[32] * 3)
    lit = lit_of(ir.TracedLighting(), scene, domain=domain, voxelize=ir.ExactOverlap())
    assert len(lit.voxels) == 32 * 32
    surface, volume = ir.prefilter(ir.SurfaceCoverage(), lit), ir.prefilter(ir.VolumeCoverage(), lit)
    six = ir.prefilter(ir.Anisotropic(), lit)
    edge_on = 1.0  # of one texel; two in a row hide each other, and two of four rows are empty
    for i in range(surface.levels):
        assert surface.level(i)[..., 3].max() == 1 and surface.level(i)[..., 3].max(2 - axis).min() == 1
        assert volume.level(i)[..., 3].max() == 2.0**-i
        for face in range(6):
            want = 1 if face // 2 == axis else edge_on
            assert six.level(i, face)[..., 3].max() == pytest.approx(want, rel=2**-10 * (i + 1))  # half floats
        edge_on = (1 - (1 - edge_on) ** 2) / 2


def test_surface_coverage_is_a_quarter_of_the_sum_clamped_with_the_mean_colour():
    # Two voxels of a 2 x 2 x 2 cube: opacity 1/2, radiance half of each.
    bright, dark = quad_at(0, (0.8,) * 3), quad_at(1, (0.2,) * 3)
    domain = _core.Domain(lower=[0.0] * 3, voxel_size=1.0, cells=[2, 2, 2])
    lit = lit_of(ir.TracedLighting(), scene_of(bright, dark, lights=[SUN]), domain=domain)
    assert len(lit.voxels) == 2
    texel = ir.prefilter(ir.SurfaceCoverage(), lit).level(1).ravel()
    assert np.allclose(texel, (0.25, 0.25, 0.25, 0.5), atol=1e-3)
    texel = ir.prefilter(ir.VolumeCoverage(), lit).level(1).ravel()
    assert np.allclose(texel, (0.125, 0.125, 0.125, 0.25), atol=1e-3)


def quad_at(x, albedo):
    """A small horizontal square in the middle of voxel (x, 0, 0) of unit voxels."""
    return quad([[x + 0.2, 0.5, 0.8], [x + 0.8, 0.5, 0.8], [x + 0.8, 0.5, 0.2], [x + 0.2, 0.5, 0.2]], albedo=albedo)


def test_anisotropic_voxels_show_each_side_its_own_light_and_hide_what_is_behind():
    # A sheet lit from above only: bright from above, dark from below. Level 1 is seen through face 3 (+y) by an eye above.
    domain = _core.Domain(lower=[-1.0, -1.0, -1.0], voxel_size=0.5, cells=[4, 4, 4])
    scene = scene_of(floor(0.25, albedo=(0.5,) * 3), floor(-0.25, albedo=(0.25,) * 3), lights=[SUN])
    pyramid = ir.prefilter(ir.Anisotropic(), lit_of(ir.TracedLighting(both_sides=True), scene, domain=domain))
    top, bottom = pyramid.level(2, 3).ravel(), pyramid.level(2, 2).ravel()
    assert np.allclose(top, (0.5, 0.5, 0.5, 1), atol=1e-3)  # the upper sheet hides the lower one
    assert np.allclose(bottom, (0, 0, 0, 1), atol=1e-3)
    # Lit on the front only, both sides pass for as bright as the front.
    pyramid = ir.prefilter(ir.Anisotropic(), lit_of(ir.TracedLighting(), scene, domain=domain))
    assert np.allclose(pyramid.level(2, 3).ravel(), (0.5, 0.5, 0.5, 1), atol=1e-3)
    assert np.allclose(pyramid.level(2, 2).ravel(), (0, 0, 0, 1), atol=1e-3)  # the lower sheet lies in the upper one's shadow


DOWN, UP = (0, 1, 4, 5), (2, 3, 6, 7)  # octants of directions that go down, up: 1, 2 and 4 stand for x, y, z above 0


def test_octants_show_the_side_that_an_eye_looking_that_way_sees_at_every_level():
    # The sheets of the six faces: lit from above, the lower one in the shadow of the upper.
    domain = _core.Domain(lower=[-1.0, -1.0, -1.0], voxel_size=0.5, cells=[4, 4, 4])
    scene = scene_of(floor(0.25, albedo=(0.5,) * 3), floor(-0.25, albedo=(0.25,) * 3), lights=[SUN])
    pyramid = ir.prefilter(ir.OctantCoverage(), lit_of(ir.TracedLighting(both_sides=True), scene, domain=domain))
    for octant in DOWN:
        assert np.allclose(pyramid.level(0, octant)[:, 2], (0.5, 0.5, 0.5, 1), atol=1e-3)
    for octant in UP:
        assert np.allclose(pyramid.level(0, octant)[:, 2], (0, 0, 0, 1), atol=1e-3)
        assert np.allclose(pyramid.level(2, octant).ravel(), (0, 0, 0, 1), atol=1e-3)
    surface = ir.prefilter(ir.SurfaceCoverage(), lit_of(ir.TracedLighting(), scene, domain=domain))
    for i in range(pyramid.levels):
        for octant in range(8):
            assert np.allclose(pyramid.level(i, octant)[..., 3], surface.level(i)[..., 3], atol=1e-3)


def test_of_two_voxels_in_a_coarser_texel_an_eye_sees_most_of_the_nearer():
    # Two sheets in the two layers of one texel, lit from above and from below. Down y an eye meets the red one alone, along x and z
    # as much of the green sheet's dark top: two thirds are red. Upwards the red sheet's dark underside hides nothing.
    domain = _core.Domain(lower=[-1.0, -1.0, -1.0], voxel_size=1.0, cells=[2, 2, 2])
    sheets = floor(0.5, albedo=(0.8, 0.0, 0.0)), floor(-0.5, albedo=(0.0, 0.8, 0.0))
    suns = [SUN, ir.DirectionalLight(direction=(0, 1, 0), irradiance=(np.pi,) * 3)]
    pyramid = ir.prefilter(ir.OctantCoverage(), lit_of(ir.TracedLighting(both_sides=True), scene_of(*sheets, lights=suns), domain=domain))
    for octant in DOWN:
        assert np.allclose(pyramid.level(1, octant).ravel(), (0.8 * 2 / 3, 0, 0, 1), atol=1e-3)
    for octant in UP:
        assert np.allclose(pyramid.level(1, octant).ravel(), (0, 0.8, 0, 1), atol=1e-3)


def test_every_block_of_voxels_starts_in_the_dark():
    # Stairs that face up and down in turns, lit from above: no side keeps light of a block before it, whichever thread lit that.
    steps = [quad(np.asarray([[x, y, 1], [x + 1, y, 1], [x + 1, y, -1], [x, y, -1]][:: 1 if y % 2 else -1], float), albedo=(0.5,) * 3)
             for x, y in enumerate(range(16))]  # fmt: skip
    domain = _core.Domain(lower=[0.0, -0.5, -1.0], voxel_size=1 / 16, cells=[256, 256, 32])
    lit = lit_of(ir.TracedLighting(both_sides=True), scene_of(*steps, lights=[SUN]), domain=domain)
    up = lit.voxels.normal[:, 1] > 0
    assert up.any() and (~up).any() and len(up) > 4096
    np.testing.assert_allclose(lit.radiance, np.where(up, 0.5, 0.0)[:, None].repeat(3, 1), atol=1e-5)
    np.testing.assert_allclose(lit.back, np.where(up, 0.0, 0.5)[:, None].repeat(3, 1), atol=1e-5)


def test_a_side_that_no_light_falls_on_hides_no_other_surface_in_the_same_texel():
    # A floor and a wall on it, both lit on their fronts. Looking up at the wall's foot from the room one sees the wall, not the
    # black underside of the floor.
    domain = _core.Domain(lower=[0.0, 0.0, 0.0], voxel_size=1.0, cells=[2, 2, 2])
    ground = quad([[0, 0.5, 2], [2, 0.5, 2], [2, 0.5, 0], [0, 0.5, 0]], albedo=(0.2,) * 3)
    wall = quad([[0, 1.01, 0.5], [2, 1.01, 0.5], [2, 2, 0.5], [0, 2, 0.5]], albedo=(0.8,) * 3)
    sun = ir.DirectionalLight(direction=(0, -1, -1), irradiance=(np.pi * np.sqrt(2),) * 3)
    lit = lit_of(ir.TracedLighting(both_sides=True), scene_of(ground, wall, lights=[sun]), domain=domain)
    pyramid = ir.prefilter(ir.OctantCoverage(), lit)
    for octant in (2, 3):  # up and towards the wall
        assert np.allclose(pyramid.level(1, octant).ravel(), (0.8, 0.8, 0.8, 1), atol=2e-3)
    for octant in (6, 7):  # up and from behind the wall: nothing that is lit
        assert not pyramid.level(1, octant)[..., :3].any() and pyramid.level(1, octant)[..., 3] == 1


def test_a_slab_within_one_voxel_is_lit_above_and_below_where_its_surfaces_are():
    # Top and bottom of a slab a tenth of a voxel thick: the bottom is lit by a lamp below it, not by the slab's inside.
    slab = box((-1, 0.2, -1), (1, 0.225, 1), material=ir.Material(albedo=(0.5,) * 3))
    up = ir.DirectionalLight(direction=(0, 1, 0), irradiance=(np.pi / 2,) * 3)
    domain = _core.Domain(lower=[-1.125, 0.0, -1.125], voxel_size=0.25, cells=[9, 2, 9])
    lit = lit_of(ir.TracedLighting(both_sides=True), scene_of(slab, lights=[SUN, up]), domain=domain)
    x, _, z = lit.voxels.position.T
    inner = (abs(x) < 0.8) & (abs(z) < 0.8)
    sides = np.sort(np.stack([lit.radiance[inner, 0], lit.back[inner, 0]]), axis=0)
    assert np.allclose(sides[0], 0.25, rtol=1e-4) and np.allclose(sides[1], 0.5, rtol=1e-4)


def test_an_empty_scene_gives_one_texel_of_air(lighting, coverage):
    scene = ir.Scene(meshes=[], lights=[SUN])
    pyramid = ir.prefilter(coverage, lit_of(lighting, scene))
    assert pyramid.levels == 1 and not pyramid.level(0).any()
    assert pyramid.counts.asdict() == {}


def test_prefiltered_pyramids_have_the_same_bits_at_one_and_two_threads(coverage):
    lit = lit_of(ir.TracedLighting(both_sides=True), ir.scenes.cornell_box(), 50)
    results = []
    for threads in (1, 2):
        with _core.Threads(threads):
            results.append(ir.prefilter(coverage, lit))
    for i in range(results[0].levels):
        for face in range(results[0].faces):
            assert np.array_equal(results[0].level(i, face), results[1].level(i, face))


def test_bytes_are_those_of_the_arrays(coverage):
    lit = lit_of(ir.TracedLighting(), scene_of(floor(), box()), 16)
    grid = lit.voxels
    arrays = (grid.cell, grid.albedo, grid.normal, grid.emission, grid.position, grid.opacity, grid.area)
    assert grid.bytes == sum(a.nbytes for a in arrays) + len(grid) * 64  # 64: the points where both sides are lit
    assert lit.bytes == lit.radiance.nbytes
    pyramid = ir.prefilter(coverage, lit)
    sizes = [np.array(pyramid.level(i).shape[:3]) + 2 for i in range(pyramid.levels)]  # one texel of border on all sides
    assert pyramid.bytes == sum(8 * s.prod() * (pyramid.faces if i > 0 or pyramid.faces in (4, 8) else 1) for i, s in enumerate(sizes))


def test_turned_triangles_turn_the_front():
    down = dataclasses.replace(floor(), triangles=QUAD[:, ::-1].copy())
    assert not lit_of(ir.TracedLighting(), scene_of(down, lights=[SUN])).radiance.any()
