"""Surfels, links and caches: flux from the lights to the pixels; every approximation against what it stands for."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from voxel_scenes import box, floor

import interreflect as ir
from interreflect import _core, stages

SIZE = (48, 36)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=2048), place_caches=ir.LightMap(texels=32, grid=ir.CacheGrid(nx=6, ny=6, nz=6)),
)  # fmt: skip


@cache
def cornell_box():
    return ir.scenes.cornell_box()


def lamp_box(lights):
    sun = ir.DirectionalLight(direction=(0.1, -0.2, -1), irradiance=(3, 2, 1))
    lamp = ir.PointLight(position=(0, 0.5, 0), intensity=(1, 1, 1))
    return cornell_box().replace(lights=(sun, lamp)[:lights])


@cache
def tree():
    return stages.cluster_surfels(ir.Agglomerative(), stages.place_surfels(ir.HaltonSurfels(surfels=2048), cornell_box()))


@cache
def sites():
    return stages.place_caches(ir.CacheGrid(nx=8, ny=8, nz=8), cornell_box())


@cache
def radiance():
    pixels = stages.surfel_pixels(tree(), cornell_box())
    return np.asarray(ir.shadow(ir.TracedShadows(samples=16), cornell_box(), pixels).radiance)


def lit(technique, chrominance_bands=0, radiosity=False):
    links = stages.link(technique, sites(), tree(), cornell_box())
    sent = stages.pull(tree(), radiance(), radiosity)
    made = stages.light_caches(technique, links, sites(), tree(), sent, cornell_box(), chrominance_bands)
    return np.float32(made.coefficients) * np.asarray(made.unit)[:, None]


def distance(a, b):
    return float(np.linalg.norm(a - b) / np.linalg.norm(b))


def test_the_roots_flux_is_that_of_all_surfels_and_every_node_has_that_of_its_leaves():
    sent = np.asarray(stages.pull(tree(), radiance()).value)
    area = np.asarray(tree().surfels.area)[:, None]
    own = np.pi * radiance().reshape(-1, 3)[: len(tree())] * area
    assert sent[-1] == pytest.approx(own.sum(0), rel=1e-4)
    for node in (0, 100, 1000, len(sent) - 2):
        end, count = tree().leaf_end[node], tree().leaves[node]
        assert sent[node] == pytest.approx(own[end - count : end].sum(0), rel=1e-4)
    mean = np.asarray(stages.pull(tree(), radiance(), radiosity=True).value)
    assert mean == pytest.approx(sent / np.asarray(tree().area)[:, None], rel=1e-3, abs=1e-6)


def test_light_that_is_brighter_changes_the_caches_units_alone():
    links = stages.link(ir.ShLinks(links=64), sites(), tree(), cornell_box())
    made = [_core.light_caches(links, stages.pull(tree(), radiance() * np.float32(factor)), 4) for factor in (1, 2**30, 2**-30)]
    for other, factor in zip(made[1:], (2**30, 2**-30), strict=True):
        assert (other.coefficients == made[0].coefficients).all()
        assert (np.asarray(other.unit) == np.asarray(made[0].unit) * factor).all()


def test_shadow_maps_that_are_given_light_as_a_techniques_own_do():
    technique, pixels = ir.ShadowMap(size=64), stages.surfel_pixels(tree(), lamp_box(1))
    given = stages.shadow(technique, lamp_box(1), pixels, maps=stages.shadow_maps(technique, lamp_box(1)))
    assert (np.asarray(given.radiance) == np.asarray(stages.shadow(technique, lamp_box(1), pixels).radiance)).all()
    assert np.asarray(given.radiance).max() > 0
    with pytest.raises(ValueError, match="maps of 2 lights, the scene has 1"):
        stages.shadow(technique, lamp_box(1), pixels, maps=stages.shadow_maps(technique, lamp_box(2)))


def test_links_to_every_surfel_are_the_sum_over_all_surfels():
    exact = lit(ir.AllSurfels(samples=0))
    projected, cones = (distance(lit(technique(links=4096)), exact) for technique in (ir.ShLinks, ir.RuntimeProjection))
    assert projected < 1e-3  # half floats
    assert cones < 0.1  # and a surfel nearby is no round cone


def test_the_more_links_the_nearer_to_all_surfels():
    exact = lit(ir.AllSurfels(samples=0))
    for technique in (ir.ShLinks, ir.RuntimeProjection):
        errors = [distance(lit(technique(links=n)), exact) for n in (16, 64, 256, 1024)]
        assert errors == sorted(errors, reverse=True) and errors[-1] < 0.3 * errors[0]


def test_sampled_surfels_come_to_all_surfels():
    exact = lit(ir.AllSurfels(samples=0))
    few, many = (distance(lit(ir.AllSurfels(samples=n)), exact) for n in (64, 1024))
    assert many < 0.4 * few


def test_radiosity_pulled_is_flux_pulled():
    for technique in (ir.ShLinks, ir.RuntimeProjection):
        assert distance(lit(technique(pull="radiosity"), radiosity=True), lit(technique())) < 2e-3


def test_chrominance_in_all_bands_is_colour_and_in_fewer_leaves_luma_as_it_is():
    colour = lit(ir.ShLinks(links=64))
    fewer = lit(ir.ShLinks(links=64), chrominance_bands=2)
    red, green, blue = np.split(colour, 3, axis=1)
    assert fewer.shape[1] == 16 + 2 * 4
    # Half floats: each is rounded by at most 2^-11 of its cache's largest, here and in what it is compared with.
    rounding = 2**-11 * (np.abs(colour).max(1) + np.abs(fewer).max(1))[:, None]
    assert (np.abs(fewer[:, :16] - (red / 4 + green / 2 + blue / 4)) <= rounding).all()
    assert (np.abs(fewer[:, 16:20] - (red - blue)[:, :4] / 2) <= rounding).all()


def test_windows_scale_every_band_by_their_formula():
    """[Sloan 2008]: hanning (1 + cos(pi l / w)) / 2, lanczos sin(pi l / w) / (pi l / w), at w bands."""
    band = np.repeat(np.arange(4), 2 * np.arange(4) + 1)
    of = {"none": np.ones(16), "hanning": (1 + np.cos(np.pi * band / 4)) / 2, "lanczos": np.sinc(band / 4)}
    links, sent = stages.link(ir.ShLinks(links=64), sites(), tree(), cornell_box()), stages.pull(tree(), radiance())

    def coefficients(window, chrominance_bands):
        made = stages.light_caches(ir.ShLinks(), links, sites(), tree(), sent, cornell_box(), chrominance_bands, window=window)
        return np.asarray(made.coefficients)

    for chrominance in (4, 2):
        plain = coefficients("none", chrominance)
        for window, scale in of.items():
            all_three = np.concatenate([scale, scale[: chrominance**2], scale[: chrominance**2]])
            assert coefficients(window, chrominance) == pytest.approx(plain * all_three, rel=1e-3, abs=1e-3 * float(np.abs(plain).max()))


def test_caches_that_no_pixel_reads_may_stay_black_and_no_pixel_sees_it():
    grid = METHOD.replace(place_caches=ir.CacheGrid(nx=6, ny=6, nz=6))
    for changes in ({}, {"link": ir.RuntimeProjection(links=48)}, {"bounces": 3}, {"emitters": "links"}):
        every, read = (grid.replace({**changes, "lit_caches": way}).render(cornell_box(), size=SIZE) for way in ("all", "read"))
        assert (every.image == read.image).all()
        lit = [frame.profile.stages["light_caches"].counts["links"] for frame in (every, read)]
        assert lit[1] < lit[0], changes
    used = stages.used_caches(sites(), ir.trace_gbuffer(cornell_box(), None, SIZE))
    assert 0 < used.sum() < len(used)
    with pytest.raises(ValueError, match=r"`used` tells of 3 caches, the links are of"):
        links = stages.link(ir.ShLinks(links=8), sites(), tree(), cornell_box())
        _core.light_caches(links, stages.pull(tree(), radiance()), 4, 0, np.ones(3, np.uint8))


def test_lobes_in_spherical_harmonics_come_to_the_links_themselves_with_the_bands():
    scene = ir.scenes.cornell_box(box="glossy")
    prepared = METHOD.prepare(scene)
    gbuffer = ir.trace_gbuffer(scene, None, SIZE)
    sent = stages.pull(prepared.state["surfels"], np.asarray(ir.shadow(ir.TracedShadows(), scene, prepared.state["pixels"]).radiance))
    caches = prepared.state["sites"]
    for technique in (ir.ShLinks, ir.RuntimeProjection):
        errors = []
        for bands in (2, 3, 5, 7):
            links = stages.link(technique(bands=bands, links=2048, near_rays=0), caches, prepared.state["surfels"], scene)
            exact = stages.evaluate(ir.DirectLinks(), None, caches, gbuffer, scene, links, sent)
            lit = stages.light_caches(technique(bands=bands), links, caches, prepared.state["surfels"], sent, scene)
            lobes = stages.evaluate(ir.SphericalHarmonicLobes(), lit, caches, gbuffer, scene)
            errors.append(distance(np.asarray(lobes.gathered.irradiance), np.asarray(exact.gathered.irradiance)))
        # A surfel a link, in one direction: measured .095, .013, .004, .002 and .095, .014, .006, .005.
        assert errors[-1] < 0.008 and errors == sorted(errors, reverse=True), errors


def test_links_and_caches_have_the_bytes_of_the_papers_formulas():
    """Buffers 5.1 and 5.2 of the paper, and the caches' coefficients, of which each has a unit besides."""
    links, caches = 64, len(sites())
    projected = stages.link(ir.ShLinks(links=links, bands=3), sites(), tree(), cornell_box())
    assert projected.bytes == 4 * caches * (links // 2) * (2 + 3**2) + 128  # what a vector may read beyond the end
    cones = stages.link(ir.RuntimeProjection(links=links), sites(), tree(), cornell_box())
    assert cones.bytes == 12 * caches * links + 192  # what a vector may read beyond the end
    sent = stages.pull(tree(), radiance())
    assert _core.light_caches(projected, sent, 3).bytes == caches * (2 * 3 * 9 + 4) + 32


def test_threads_and_repeats_give_the_same_bits():
    frames = [METHOD.render(cornell_box(), size=SIZE, seed=3, threads=threads) for threads in (1, 2, 2)]
    assert all((frame.image == frames[0].image).all() for frame in frames)


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_the_scenes_scale_changes_nothing(scale):
    """Half floats neither overflow nor flush."""

    def indirect(factor, technique):
        cube = box((-factor,) * 3, (factor,) * 3, inward=True, material=ir.Material(albedo=(0.5, 0.25, 0.75)))
        lamp = ir.PointLight(position=(0.3 * factor, 0.2 * factor, 0), intensity=(factor**2,) * 3)
        view = ir.Camera(position=(0.3 * factor, 0.2 * factor, 0.9 * factor), target=(0, 0, -factor), fov_x=90)
        scene = ir.Scene(meshes=[cube], lights=[lamp], cameras={"view": view})
        return np.asarray(METHOD.replace(link=technique).render(scene, size=(16, 12)).indirect)

    for technique in (ir.ShLinks(), ir.RuntimeProjection()):
        there, here = indirect(scale, technique), indirect(1.0, technique)
        assert there == pytest.approx(here, rel=0.02)


def test_a_moved_light_costs_no_precomputation_and_gives_what_a_new_one_would():
    lamp = ir.PointLight(position=(0.2, 0.3, 0.1), intensity=(1, 1, 1))

    def room(*lights):
        view = ir.Camera(position=(0.3, 0.2, 0.9), target=(0, 0, -1), fov_x=90)
        cube = box(inward=True, material=ir.Material(albedo=(0.5,) * 3))
        return ir.Scene(meshes=[cube], lights=lights, cameras={"view": view})

    moved = room(ir.PointLight(position=(-0.5, 0.3, 0.4), intensity=(1, 2, 1)))
    later = METHOD.prepare(room(lamp)).render(size=SIZE, scene=moved)
    assert (later.image == METHOD.render(moved, size=SIZE).image).all()


def test_moving_bodies_receive_light_from_the_grid_and_send_none_on():
    def scene(height):
        pose = np.eye(4)
        pose[1, 3] = height
        cube = box((-0.2,) * 3, (0.2,) * 3, body="cube", material=ir.Material(albedo=(0.9,) * 3))
        lamp = ir.PointLight(position=(0.2, 0.6, 0.5), intensity=(1, 1, 1))
        view = ir.Camera(position=(0, 0, 0.95), target=(0, -0.3, -1), fov_x=90)
        return ir.Scene(meshes=[box(inward=True), cube], lights=[lamp], bodies={"cube": pose}, cameras={"view": view})

    prepared = METHOD.prepare(scene(-0.7))
    assert 0 < len(prepared.state["surfels"]) <= 2048
    frame = prepared.render(size=SIZE, scene=scene(0.0))
    seen = np.asarray(ir.trace_gbuffer(scene(0.0), "view", SIZE).body) > 0
    assert seen.sum() > 50
    assert (np.asarray(frame.indirect)[seen].max(-1) > 0).all()


def test_light_does_not_come_through_a_sheet_with_two_sides():
    """A floor that is lit from above; below it is dark."""
    scene = ir.Scene(
        meshes=[floor(half=1, albedo=(0.5,) * 3), box((-1, -1, -1), (1, -0.6, 1), material=ir.Material(albedo=(0.5,) * 3))],
        lights=[ir.SpotLight(position=(0, 1, 0), direction=(0, -1, 0), intensity=(1, 1, 1), inner=20, outer=25)],
        cameras={"view": ir.Camera(position=(0, -0.3, 3), target=(0, -0.3, 0), fov_x=50)},
    )  # fmt: skip
    frame = METHOD.render(scene, size=SIZE)
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    below = np.isfinite(gbuffer.depth) & (np.asarray(gbuffer.position)[..., 1] < -0.01)
    assert below.sum() > 50
    assert np.asarray(frame.indirect)[below].max() < 1e-3


@pytest.mark.parametrize(("changes", "error", "message"), [
    ({"evaluate": ir.SphericalHarmonicLobes(chrominance_bands=5)}, ValueError, "the bands of the links"),
    ({"sky": ir.ConeSky()}, ValueError, "ConeSky needs cones"),
    ({"lit_caches": "read", "bounces": None}, ValueError, "needs a number of bounces"),
    ({"emitters": "cones"}, ValueError, "emitters must be one of rays, links"),
    ({"link": ir.ShLinks(bands=4), "evaluate": ir.SphericalHarmonicLobes(chrominance_bands=6)}, ValueError, "the bands of the links"),
    ({"shadow": ir.VoxelCones()}, ValueError, "VoxelCones needs voxels"),
])  # fmt: skip
def test_bad_combinations_are_value_errors(changes, error, message):
    with pytest.raises(error, match=message):
        ir.methods.IlluminanceComposition(**changes)


def test_products_that_do_not_belong_together_are_value_errors():
    links = stages.link(ir.ShLinks(links=8), sites(), tree(), cornell_box())
    other = stages.cluster_surfels(ir.KdTree(), stages.place_surfels(ir.HaltonSurfels(surfels=100), cornell_box()))
    short = np.zeros((50, 3), np.float32)
    with pytest.raises(ValueError, match="light of 50 surfels for a tree of"):
        stages.pull(other, short)
    sent = stages.pull(other, np.ones((200, 3), np.float32))
    with pytest.raises(ValueError, match="links into a tree of"):
        _core.light_caches(links, sent, 4)
    mean = stages.pull(tree(), radiance(), radiosity=True)
    with pytest.raises(ValueError, match="these links take flux, not radiosity"):
        _core.light_caches(links, mean, 4)
    flux = stages.pull(tree(), radiance())
    with pytest.raises(ValueError, match="links of 4 bands for caches of 5"):
        _core.light_caches(links, flux, 5)
    with pytest.raises(ValueError, match=r"chrominance_bands must lie in \[0, 4\], got 5"):
        _core.light_caches(links, flux, 4, 5)
    with pytest.raises(ValueError, match="more than 4 GiB"):
        stages.link(ir.ShLinks(links=65536, bands=8), stages.place_caches(ir.CacheGrid(), cornell_box()), tree(), cornell_box())


EXTREMES = {
    "one surfel": {"place_surfels": ir.XorshiftSurfels(surfels=1)},
    "fewer surfels than links": {"place_surfels": ir.HaltonSurfels(surfels=20)},
    "one band": {"link": ir.ShLinks(bands=1)},
    "eight bands": {"link": ir.RuntimeProjection(bands=8, links=8)},
    "a map of one texel": {"place_caches": ir.LightMap(texels=1)},
    "a map without area": {"place_caches": ir.LightMap(area_share=0.0)},
    "one cache": {"place_caches": ir.CacheGrid(nx=1, ny=1, nz=1)},
}


@pytest.mark.parametrize("changes", EXTREMES.values(), ids=EXTREMES.keys())
def test_extremes_give_finite_light(changes):
    frame = METHOD.replace(changes).render(cornell_box(), size=(24, 18))
    assert np.isfinite(frame.image).all() and frame.image.min() >= 0


@pytest.mark.parametrize("meshes", [[], [floor(half=1)], [box(inward=True, material=ir.Material(albedo=(0, 0, 0)))]])
def test_scenes_without_indirect_light_have_none(meshes):
    scene = ir.Scene(
        meshes=meshes, lights=[ir.PointLight(position=(0.1, 0.5, 0), intensity=(1, 1, 1))],
        cameras={"view": ir.Camera(position=(0, 0.5, 0.9), target=(0, 0, 0), fov_x=60)},
    )  # fmt: skip
    assert METHOD.render(scene, size=(24, 18)).indirect.max() == 0
