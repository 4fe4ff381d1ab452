"""Light that shadow maps bring to voxels, against shadow rays."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import box, floor, scene_of

import interreflect as ir
from interreflect import _core

LIGHTS = {
    "sun": ir.DirectionalLight(direction=(0.3, -1, 0.2), irradiance=(3, 2, 1)),
    "point": ir.PointLight(position=(0.37, 1.83, -0.21), intensity=(2, 3, 4)),
    "spot": ir.SpotLight(position=(-0.8, 2.6, 0.7), direction=(0.3, -1, -0.2), intensity=(9, 8, 7), inner=30, outer=45),
    "wide spot": ir.SpotLight(position=(-0.8, 2.6, 0.7), direction=(0.3, -1, -0.2), intensity=(9, 8, 7), inner=60, outer=85),
}


def furnished(light):
    """A floor and a box above it that shades a part of it; nothing ends on a face of a voxel."""
    return scene_of(floor(0.013, half=1.97), box((-0.61, 0.53, -0.57), (0.59, 1.11, 0.63)), lights=[light])


def both(scene, size, resolution=32, **knobs):
    voxels = ir.voxelize(ir.ExactOverlap(), scene, ir.Grid(resolution=resolution).place(scene))
    return voxels, *(
        np.concatenate([(lit := ir.light_voxels(technique, scene, voxels)).radiance, lit.back])
        for technique in (ir.TracedLighting(both_sides=True), ir.ShadowMapInjection(size=size, both_sides=True, **knobs))
    )


@pytest.mark.parametrize("light", LIGHTS)
def test_fine_maps_light_voxels_as_shadow_rays_do(light):
    scene = furnished(LIGHTS[light])
    errors = []
    for size in (24, 96, 1536):
        _, traced, injected = both(scene, size)
        errors.append(np.abs(traced - injected).mean() / traced.mean())
    assert errors[2] < errors[1] < errors[0]
    # What remains are points within 1.5 texels of a shadow's border, 1/20 of a voxel and more, and a cube's sides are wider.
    assert errors[2] < 0.02


def test_an_open_floor_gets_exactly_its_irradiance_at_every_voxel():
    scene = scene_of(floor(albedo=(0.5, 0.25, 1.0)), lights=[LIGHTS["sun"]])
    _, traced, injected = both(scene, 256)
    lit = traced.max(1) > 0
    assert np.allclose(injected[lit], traced[lit], rtol=1e-4) and not injected[~lit].any()


def test_a_map_coarser_than_the_voxels_leaves_gaps_and_a_finer_one_none():
    # CLAIMS F13: a floor straight below the sun; the map spans the floor, so `size` texels meet 64 voxels across.
    sun = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(1, 1, 1))
    scene = scene_of(floor(), lights=[sun])
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=64).place(scene))
    dark = {}
    for size in (16, 32, 128):
        dark[size] = 1 - (ir.light_voxels(ir.ShadowMapInjection(size=size), scene, voxels).radiance.max(1) > 0).mean()
    # Every texel lights at most one voxel; the map's margin of a texel a side misses the floor.
    for size in (16, 32):
        assert (size - 2) ** 2 * 0.9 < (1 - dark[size]) * len(voxels) <= size**2
    assert dark[128] == 0


def test_the_bare_base_colour_is_injected_as_printed_whatever_the_light():
    for light in LIGHTS.values():
        scene = scene_of(floor(albedo=(0.5, 0.25, 1.0)), lights=[light, LIGHTS["sun"]])
        voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=24).place(scene))
        lit = ir.light_voxels(ir.ShadowMapInjection(radiance="base_colour"), scene, voxels)
        assert np.allclose(lit.radiance, voxels.albedo, rtol=1e-5)


def test_maps_have_the_same_bits_at_any_number_of_threads():
    scene = furnished(LIGHTS["point"])
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=48).place(scene))
    results = []
    for threads in (1, 2, None):
        with _core.Threads(threads):
            results.append(ir.light_voxels(ir.ShadowMapInjection(both_sides=True), scene, voxels))
    for other in results[1:]:
        assert np.array_equal(results[0].radiance, other.radiance) and np.array_equal(results[0].back, other.back)


def test_texels_light_the_side_that_they_meet():
    below = ir.DirectionalLight(direction=(0, 1, 0), irradiance=(np.pi,) * 3)
    scene = scene_of(floor(albedo=(0.5,) * 3), lights=[below])
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=16).place(scene))
    assert not ir.light_voxels(ir.ShadowMapInjection(), scene, voxels).radiance.any()
    lit = ir.light_voxels(ir.ShadowMapInjection(both_sides=True), scene, voxels)
    assert not lit.radiance.any() and np.allclose(lit.back, 0.5, rtol=1e-4)


GRIDS = {
    "spline": ir.Grid(resolution=32, warp=ir.CubicSpline()),
    "nested": ir.Grid(resolution=24, cascades=2),
    "frustum": ir.Grid(resolution=32, warp=ir.Perspective()),
}


@pytest.mark.parametrize("grid", GRIDS)
def test_warped_and_nested_voxels_are_lit_as_by_rays_and_keep_their_history(grid):
    camera = ir.Camera(position=(0.3, 1.7, 2.9), target=(0, 0.4, 0), fov_x=70)
    scene = furnished(LIGHTS["sun"]).replace(cameras={"view": camera})
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, GRIDS[grid].place(scene, camera))
    traced = ir.light_voxels(ir.TracedLighting(), scene, voxels)
    injected = ir.light_voxels(ir.ShadowMapInjection(size=1024), scene, voxels)
    assert len(voxels) > 300 and np.abs(traced.radiance - injected.radiance).mean() < 0.03 * traced.radiance.mean()
    kept = ir.light_voxels(ir.BlendHistory(weight=1.0), scene.replace(lights=[]), voxels, history=traced)
    # A cell's centre lies where rounding may put it into its neighbour only where cells are as small as that.
    assert (kept.radiance == traced.radiance).all(1).mean() > 0.999
