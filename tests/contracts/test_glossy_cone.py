"""The glossy cone's knobs: how wide it is, and whether pixels share it."""

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core

SIZE = (64, 48)
SHARED = ir.Interleaved(width=2, height=2)


def box(lower, upper, material):
    corners = np.array([[x, y, z] for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])], np.float32)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return ir.Mesh(corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32), material=material)


def hall(right=None, sky=None, **floor):
    """A glossy floor between two walls of which one is lit; its right half may be of another material."""
    left = ir.Material(albedo=(0.2,) * 3, specular=(0.8,) * 3, **floor)
    white = ir.Material(albedo=(0.8,) * 3)
    meshes = [
        box((-2, -0.1, -2), (0, 0, 2), left), box((0, -0.1, -2), (2, 0, 2), right or left),
        box((-2, 0, -2.1), (2, 2, -2), white), box((-0.8, 0, -1), (-0.3, 0.7, -0.5), ir.Material(albedo=(0.7, 0.3, 0.1))),
    ]  # fmt: skip
    lights = [ir.DirectionalLight(direction=(0.2, -0.5, -1), irradiance=(3.0,) * 3)]
    view = ir.Camera(position=(0, 0.8, 1.6), target=(0, 0, -0.6), fov_x=60)
    return ir.Scene(meshes=meshes, lights=lights + ([sky] if sky else []), cameras={"view": view})


def shine(scene, technique, shade=None, size=SIZE):
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=48), scene.core, None))
    pyramid = ir.prefilter(ir.OctantCoverage(), ir.light_voxels(ir.TracedLighting(both_sides=True), scene, voxels))
    return ir.glossy(technique, pyramid, ir.trace_gbuffer(scene, "view", size, shade), scene, seed=1)


def test_shared_cones_show_what_every_pixels_own_show_with_a_quarter_of_the_work():
    scene = hall(roughness=0.4, sky=ir.EnvironmentLight(radiance=(0.5, 1.0, 2.0)))
    own, shared = shine(scene, ir.GlossyCone()), shine(scene, ir.GlossyCone(share=SHARED))
    for name in ("radiance", "sky"):
        a, b = getattr(own, name), getattr(shared, name)
        assert b.mean() == pytest.approx(a.mean(), rel=0.01)
        assert abs(a - b).mean() < 0.04 * a.mean()  # the floor is smooth; what is mirrored has edges, each a pixel off
    assert (shared.radiance > 0).any(2).sum() == (own.radiance > 0).any(2).sum()  # no pixel is left out
    assert shared.counts.asdict()["cones"] < 0.3 * own.counts.asdict()["cones"]


@pytest.mark.parametrize("right", [{"roughness": 0.9, "specular": (0.8,) * 3}, {}], ids=["rough", "diffuse"])
def test_pixels_share_only_with_lobes_as_wide_as_theirs(right):
    scene = hall(right=ir.Material(albedo=(0.2,) * 3, **right), roughness=0.1)
    own, shared = (shine(scene, ir.GlossyCone(share=share)).radiance for share in (ir.EveryPixel(), SHARED))
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    assert shared[gbuffer.specular.max(2) == 0].max() == 0
    # A foreign lobe beside the seam differs as the two halves do; what is left there is no more than elsewhere.
    error = abs(own - shared).mean(2)
    columns = slice(SIZE[0] // 2 - 2, SIZE[0] // 2 + 2)
    assert error[:, columns].mean() < 1.5 * error.mean()


@pytest.mark.parametrize("size", [(1, 1), (2, 1), (7, 5)])
@pytest.mark.parametrize("share", [ir.Interleaved(width=1, height=1), SHARED, ir.Interleaved(width=8, height=3)], ids=repr)
def test_shared_cones_fill_pictures_of_any_size(share, size):
    scene = hall(roughness=0.4)
    own, shared = (shine(scene, ir.GlossyCone(share=one), size=size).radiance for one in (ir.EveryPixel(), share))
    assert np.isfinite(shared).all() and np.array_equal(own.max(2) > 0, shared.max(2) > 0)


def test_one_and_two_threads_share_to_the_same_bits():
    scene, pictures = hall(roughness=0.3), []
    for threads in (1, 2):
        with _core.Threads(threads):
            pictures.append(shine(scene, ir.GlossyCone(share=SHARED)).radiance.copy())
    assert np.array_equal(*pictures)


def test_the_thesiss_aperture_is_narrower_than_the_lobe_and_a_fixed_one_is_what_it_says():
    scene = hall(roughness=0.6)
    steps = {}
    for technique in (ir.GlossyCone(), ir.GlossyCone(aperture="freed"), ir.GlossyCone(half_angle=5.4), ir.GlossyCone(half_angle=40)):
        light = shine(scene, technique)
        assert np.isfinite(light.radiance).all() and light.radiance.mean() > 0
        counts = light.counts.asdict()
        steps[repr(technique)] = counts["cone_steps"] / counts["cones"]
    lobe, freed, fixed, wide = steps.values()
    # 0.1 pi roughness is an aperture of 10.8 degrees; narrow cones take more steps. Only directions differ: the mirrored view's.
    assert freed == pytest.approx(fixed, rel=0.15) and freed > 1.5 * lobe and lobe > 0.5 * wide


def test_a_mirror_under_the_thesiss_rule_has_almost_no_aperture_and_still_advances():
    light = shine(hall(roughness=0.0), ir.GlossyCone(aperture="freed"))
    assert np.isfinite(light.radiance).all() and light.radiance.mean() > 0


@pytest.mark.parametrize("start", ["rays", "height"])
def test_every_start_shows_the_same_world(start):
    scene = hall(roughness=0.4)
    plain, other = (shine(scene, ir.GlossyCone(half_angle=7.5, start=one)).radiance for one in ("opening", start))
    # Samples lie elsewhere; from 20 degrees on, the listing's at the beginning of their steps see another world, up to a fifth darker.
    assert other.mean() == pytest.approx(plain.mean(), rel=0.1)


def test_multiplying_by_occlusion_darkens_what_cones_meet_and_leaves_the_sky():
    scene = hall(roughness=0.4, sky=ir.EnvironmentLight(radiance=(1.0,) * 3))
    plain, darker = (shine(scene, ir.GlossyCone(multiply_by_occlusion=on)) for on in (False, True))
    assert (darker.radiance <= plain.radiance).all() and darker.radiance.mean() < 0.9 * plain.radiance.mean()
    assert np.array_equal(darker.sky, plain.sky)
