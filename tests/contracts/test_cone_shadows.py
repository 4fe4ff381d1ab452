"""Shadows by cones through voxels, at pixels and at voxels."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import box, floor, scene_of

import interreflect as ir

SIZE = (96, 72)
CAMERA = ir.Camera(position=(0.4, 3.1, 3.4), target=(0, 0.1, 0), fov_x=60)
LIGHTS = {
    "sun": ir.DirectionalLight(direction=(0.3, -1, 0.2), irradiance=(3, 2, 1)),
    "point": ir.PointLight(position=(0.4, 2.2, 0.3), intensity=(3, 2, 1)),
    "spot": ir.SpotLight(position=(0.4, 2.2, 0.3), direction=(-0.2, -1, -0.1), intensity=(9, 8, 7), inner=35, outer=45),
}


def roofed(*lights):
    """A floor under a slab, which shades its middle."""
    return scene_of(floor(0, half=2), box((-0.5, 1.0, -0.5), (0.5, 1.1, 0.5)), lights=lights, cameras={"view": CAMERA})


def pyramid_of(scene, resolution=64):
    voxels = ir.voxelize(ir.ExactOverlap(), scene, ir.Grid(resolution=resolution).place(scene))
    return ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(), scene, voxels))


def pictures(scene, technique=None, pyramids=None):
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    traced = np.asarray(ir.shadow(ir.TracedShadows(), scene, gbuffer).radiance)
    cones = ir.shadow(technique or ir.VoxelCones(), scene, gbuffer, pyramids=pyramids or [pyramid_of(scene)])
    return traced, np.asarray(cones.radiance), np.asarray(gbuffer.position)


@pytest.mark.parametrize("light", LIGHTS)
def test_an_open_floor_is_lit_as_if_traced(light):
    scene = scene_of(floor(0, half=2), lights=[LIGHTS[light]], cameras={"view": CAMERA})
    traced, cones, _ = pictures(scene)
    assert traced.max() > 0 and np.allclose(cones, traced, rtol=1e-3, atol=1e-3 * traced.max())


@pytest.mark.parametrize("light", LIGHTS)
def test_shadows_of_cones_approach_traced_ones_as_voxels_shrink(light):
    scene = roofed(LIGHTS[light])
    errors = []
    for resolution in (24, 48, 96):
        traced, cones, _ = pictures(scene, pyramids=[pyramid_of(scene, resolution)])
        errors.append(np.abs(traced - cones).mean() / traced.mean())
    assert errors[2] < errors[1] < errors[0] and errors[2] < 0.08


def test_several_pyramids_multiply_what_they_let_through():
    both, bare = roofed(LIGHTS["sun"]), scene_of(floor(0, half=2))
    roof = scene_of(box((-0.5, 1.0, -0.5), (0.5, 1.1, 0.5)))
    gbuffer = ir.trace_gbuffer(both, size=SIZE)
    shadow = lambda *scenes: np.asarray(  # noqa: E731
        ir.shadow(ir.VoxelCones(half_angle=3), both, gbuffer, pyramids=[pyramid_of(s) for s in scenes]).radiance, np.float64
    )
    alone, floor_only, together = shadow(roof), shadow(bare), shadow(bare, roof)
    lit = floor_only > 1e-3
    open_floor = np.asarray(gbuffer.position)[..., 1] < 0.01
    lit &= open_floor[..., None]
    unshadowed = floor_only[lit].max(initial=0)
    assert unshadowed > 0 and np.allclose(together[lit], alone[lit] * floor_only[lit] / np.asarray(shadow(scene_far()))[lit], rtol=1e-3)


def scene_far():
    """Nothing near the cones."""
    return scene_of(floor(-50, half=0.1))


def test_cones_without_voxels_are_refused():
    scene = roofed(LIGHTS["sun"])
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    with pytest.raises(ValueError, match="VoxelCones needs the voxels"):
        ir.shadow(ir.VoxelCones(), scene, gbuffer)
    with pytest.raises(ValueError, match="VoxelCones needs the voxels"):
        ir.methods.ConstantAmbient(shadow=ir.VoxelCones()).render(scene, size=SIZE)


def test_cone_shadows_show_the_voxels():
    # CLAIMS R15, on the shadow of a slab whose edges run across the grid. Traced, its border is straight; through voxels it is ragged,
    # by about a voxel: what of the error varies within a voxel's width along the border shrinks with the voxels.
    slab = box((-0.5, 1.0, -0.5), (0.5, 1.1, 0.5))
    angle = np.radians(20)
    matrix = np.eye(4)
    matrix[[0, 0, 2, 2], [0, 2, 0, 2]] = np.cos(angle), np.sin(angle), -np.sin(angle), np.cos(angle)
    above = ir.Camera(position=(0, 30, 0.01), target=(0, 0, 0), fov_x=8)
    sun = ir.DirectionalLight(direction=(0.6, -1, 0.1), irradiance=(3, 3, 3))
    scene = scene_of(floor(0, half=2), slab.replace(transform=matrix), lights=[sun], cameras={"view": above})
    rough = {}
    for resolution in (24, 48, 96):
        traced, cones, position = pictures(scene, pyramids=[pyramid_of(scene, resolution)])
        error = np.where(position[..., 1] < 0.01, (cones - traced).mean(-1), 0) / traced.max()
        width = SIZE[0] // resolution | 1  # about a voxel, in pixels: the picture is as wide as the floor
        smooth = np.mean([np.roll(error, (i, j), (0, 1)) for i in range(-width, width + 1) for j in range(-width, width + 1)], 0)
        rough[resolution] = np.abs(error - smooth).mean()
    assert rough[24] > rough[48] > rough[96] > 0
    assert rough[24] > 0.02, "of the light on the floor: far more than the noise of rays, which is none"


@pytest.mark.parametrize("row", [3, 4])
def test_closed_spheres_are_lit_alike_through_cones(row):
    # GROUND_TRUTH 3: radiance 1/2 after one reflection, everywhere. 4: a spot on one cap lights that cap alone.
    case = ir.scenes.closed_form(row, **({"part": "direct"} if row == 3 else {}))
    voxels = ir.voxelize(ir.ExactOverlap(), case.scene, ir.Grid(resolution=32).place(case.scene))
    cones = ir.light_voxels(ir.ConeLighting(), case.scene, voxels).radiance
    traced = ir.light_voxels(ir.TracedLighting(), case.scene, voxels).radiance
    assert cones.mean() == pytest.approx(traced.mean(), rel=0.05)
    if row == 3:
        assert np.allclose(cones, 0.5, rtol=0.1) and cones.mean() == pytest.approx(case.value, rel=0.02)
