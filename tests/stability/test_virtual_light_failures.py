"""Failures of virtual lights: their truths, what they read where the answer is known, and that planted faults are noticed."""

from functools import partial

import numpy as np
import pytest
from faults import overwrite

import interreflect as ir
from interreflect import stages
from interreflect.scenes.builtin.lit_patch import SEEN, umbra
from interreflect.stability.measures.virtual_lights import _width
from interreflect.stability.virtual_light_failures import VIRTUAL_LIGHTS

ROWS = {row.name: row for row in VIRTUAL_LIGHTS}
FEW = ir.HaltonLights(lights=64)
MAPS = ir.methods.VirtualAreaLights(
    map_size=128, sample_lights=FEW, shadow_lights=ir.ImperfectShadowMaps(), filter_shadows=ir.Pcss(), shade_lights=ir.DiskVector()
)
RAYS = MAPS.replace(shadow_lights=ir.TracedVisibility(), filter_shadows=ir.TracedDisk(samples=4))
POINTS = RAYS.replace(cluster_lights=None, shade_lights=ir.Point(), share=ir.EveryPixel())


def floor_factors(count):
    """Form factors from a corner's floor, point by point of a picture, to its wall: Howell B-4 turned by 90 degrees."""
    place = (np.arange(count) + 0.5) / count
    distance, along = place[None, :], place[:, None]

    def half(width):
        x, y = 1 / width, distance / width
        return (np.arctan(1 / y) - y / np.hypot(x, y) * np.arctan(1 / np.hypot(x, y))) / (2 * np.pi)

    return half(along) + half(1 - along)


def test_the_corner_in_the_sun_is_closed_form_6():
    factors = floor_factors(48)
    assert factors.mean() == pytest.approx(0.200044, rel=2e-3)  # 48 points a side of a function with a kink at the edge
    frame = ir.methods.PathTracing(spp=512, bounces=1).render(ir.scenes.corner("sun"), "receiver", size=(48, 48))
    rows = frame.indirect.mean((0, 2))
    # 25,000 paths a column: noise of at most 1 % where the wall is far.
    assert rows == pytest.approx(0.5 / np.pi * factors.mean(0), rel=0.04)


@pytest.mark.parametrize("height", [0.05, 0.3])
def test_a_penumbra_of_paths_is_as_wide_as_similar_triangles_say(height):
    scene = ir.scenes.lit_patch("edge", height=height)
    lit = ir.scenes.lit_patch("none").replace(cameras=scene.cameras)
    paths = ir.methods.PathTracing(spp=512, bounces=1)
    shadowed, opened = (paths.render(one, size=(64, 48)).indirect for one in (scene, lit))
    # The picture is one and a half penumbras wide; at most 800 paths a column hit the patch.
    assert 1.5 * _width(shadowed, opened) == pytest.approx(1, rel=0.08)


def test_all_that_the_camera_sees_behind_the_plate_is_umbra():
    assert SEEN["plate"] < umbra(0.3)
    for name in ("light in an umbra by points", "light in an umbra by pull and push"):
        assert ROWS[name].read(RAYS, ROWS[name].hard).error == 0


def test_points_are_singular_and_disks_are_not():
    row = ROWS["singularity of few lights"]
    assert row.read(POINTS, 64).error > 4 * row.tolerance
    assert row.read(POINTS.replace(cluster_lights=ir.KMeans(), shade_lights=ir.DiskIntegral()), 64).error < row.tolerance


def test_a_bound_takes_light_or_leaves_dots():
    dots, lost = ROWS["singularity by bound"], ROWS["energy lost to a bound"]
    clamped = POINTS.replace(shade_lights=ir.ClampedPoint())
    assert dots.read(clamped, 1.0).error == 0 and dots.read(clamped, 1e5).error > dots.tolerance
    loose, tight = lost.read(clamped, 1e5), lost.read(clamped, 1.0)
    assert tight.signed < -3 * lost.tolerance and abs(loose.signed) < lost.tolerance


@pytest.mark.parametrize(("name", "easy"), [
    ("light in an umbra by points", 3e5), ("light in an umbra by pull and push", 8.0), ("light in an umbra by size of points", 2.0),
])  # fmt: skip
def test_maps_let_more_light_into_an_umbra_towards_the_hard_end(name, easy):
    row, maps = ROWS[name], MAPS.replace({"shadow_lights.point_size": 1.0})
    better, worse = row.read(maps, easy).error, row.read(maps, row.hard).error
    assert worse > max(1.2 * better, row.tolerance)


@pytest.mark.parametrize("size", [0.5, 1.0, 1.5])
def test_disks_at_random_places_leave_a_plate_as_open_as_their_overlaps_say(size):
    """Poisson: disks of s times their share of the surface leave exp(-s^2) of it open, where nothing fills holes."""
    row = ROWS["light in an umbra by size of points"]
    bare = MAPS.replace({"shadow_lights.iterations": 0, "filter_shadows": ir.SimpleLookup()})
    # Some 200 of a map's points are on the plate, of 64 maps; disks at its border cover less, texels quantize.
    assert row.read(bare, size).error == pytest.approx(np.exp(-(size**2)), abs=0.04)


def test_light_in_an_umbra_is_a_share_of_that_without_the_plate():
    row = ROWS["light in an umbra by points"]
    assert row.read(RAYS.replace(shadow_lights=ir.Unshadowed()), 1e3).error == pytest.approx(1)
    with pytest.raises(ValueError, match="no indirect light"):
        row.read(ir.methods.ConstantAmbient(), 1e3)  # a share of direct light, of which there is none


def test_flux_at_centres_errs_on_chequers_and_the_sum_of_members_does_not():
    """Middles by flux lie on white, 1.82 of the mean where black is a tenth of it; light falls off within clusters too."""
    row = ROWS["flux of clusters on chequers"]
    summed = MAPS.replace({"cluster_lights.flux": "members"})
    centred = MAPS.replace({"cluster_lights.flux": "centre"})
    assert row.read(summed, 16).error < 1e-6
    assert 0.5 * 0.82 < row.read(centred, 16).signed < 1.5 * 0.82
    assert row.read(POINTS, 16).error == 0


def test_clusters_of_a_light_that_hardly_turns_stay_where_they_are():
    row = ROWS["churn of clusters made anew"]
    assert row.read(MAPS, 1e-6).error < 1e-3
    assert row.read(MAPS, 4.0).error > row.tolerance
    assert row.read(POINTS, 4.0).error == 0


def test_blockers_at_two_heights_defeat_percentage_closer_filtering_and_not_rays_to_the_disk():
    """The mean distance of two layers is that of neither; at one height the same filter passes."""
    row = ROWS["penumbra of two layers"]
    disks = RAYS.replace({"sample_lights.lights": 4, "share": ir.EveryPixel()})
    closer = disks.replace(filter_shadows=ir.Pcss(blocker_samples=32, filter_samples=32))
    assert row.read(closer, row.easy).error < row.tolerance < row.read(closer, row.hard).error
    assert row.read(disks.replace({"filter_shadows.samples": 16}), row.hard).error < row.tolerance


def leaking(stage, *arguments, **keys):
    shadows = stage(*arguments, **keys)
    overwrite(shadows.depth, np.where(np.arange(shadows.depth.shape[-1]) % 8 == 0, np.inf, shadows.depth))
    return shadows


def half_flux(stage, *arguments, **keys):
    lights = stage(*arguments, **keys)
    overwrite(lights.flux, lights.flux / 2)
    return lights


def test_planted_faults_are_noticed(monkeypatch):
    row = ROWS["light in an umbra by size of points"]
    sound = row.read(MAPS, 4.0).error
    assert sound < row.tolerance
    monkeypatch.setattr("interreflect.methods.virtual_area_lights.shadow_lights", partial(leaking, stages.shadow_lights))
    assert row.read(MAPS, 4.0).error > row.tolerance
    monkeypatch.setattr("interreflect.stability.measures.virtual_lights.cluster_lights", partial(half_flux, stages.cluster_lights))
    assert ROWS["flux of clusters on chequers"].read(MAPS, 4).error == pytest.approx(0.5, rel=1e-5)
