"""Filters with sides in warped grids: which side a texel shows is measured in the grid's own axes."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import floor, quad, scene_of

import interreflect as ir

SIZE = (64, 48)
VOLUMES = [ir.Perspective(), ir.Perspective(linear_depth=False), ir.Spherical(far=10.0, snap=False)]
FRONT, BACK = (0.8, 0.4, 0.2), (0.1, 0.2, 0.4)  # radiance of the two sides


def towards(yaw, pitch):
    yaw, pitch = np.radians([yaw, pitch])
    return np.array([np.sin(yaw) * np.cos(pitch), np.sin(pitch), -np.cos(yaw) * np.cos(pitch)])


def screen(ahead, distance=2.0, half=0.15):
    """A small square that faces the eye at the origin, lit on both sides, and the camera that looks at it."""
    right = np.cross(ahead, (0, 1, 0)) / np.linalg.norm(np.cross(ahead, (0, 1, 0)))
    up, middle = np.cross(right, ahead), distance * ahead
    corners = [middle + half * (sx * right + sy * up) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    lights = [ir.DirectionalLight(direction=tuple(sign * ahead), irradiance=tuple(np.pi * np.array(side)))
              for sign, side in ((1, FRONT), (-1, BACK))]  # fmt: skip
    view = ir.Camera(position=(0, 0, 0), target=tuple(ahead), fov_x=60)
    return scene_of(quad(corners, albedo=(1.0,) * 3), lights=lights, cameras={"view": view})


def filtered(technique, scene, warp, resolution=32):
    domain = ir.Grid(resolution=resolution, warp=warp).place(scene, "view", SIZE)
    lit = ir.light_voxels(ir.TracedLighting(both_sides=True), scene, ir.voxelize(ir.ExactOverlap(), scene, domain))
    return ir.prefilter(technique, lit)


def colours(texels):
    seen = texels[texels[..., 3] > 0]
    assert len(seen) > 0
    return seen[:, :3] / seen[:, 3:]


@pytest.mark.parametrize("turn", [(0, 0), (45, 0), (130, 35)])
@pytest.mark.parametrize("warp", VOLUMES, ids=repr)
def test_octants_that_look_away_from_the_eye_see_what_faces_it(warp, turn):
    pyramid = filtered(ir.OctantCoverage(), screen(towards(*turn)), warp)
    # The third axis of a view volume is depth. A flat screen leans against spheres about the eye by half its angle, 4 degrees.
    free = 0.03 if not isinstance(warp, ir.Spherical) else 0.15
    for octant in range(8):
        away = octant & 4
        assert np.allclose(colours(pyramid.level(0, octant)), FRONT if away else BACK, atol=free)


@pytest.mark.parametrize("turn", [(0, 0), (45, 0), (130, 35)])
@pytest.mark.parametrize("warp", VOLUMES, ids=repr)
def test_the_two_faces_across_depth_show_the_two_sides(warp, turn):
    pyramid = filtered(ir.Anisotropic(), screen(towards(*turn), half=0.4), warp)
    for face, side in ((4, FRONT), (5, BACK)):
        assert np.allclose(colours(pyramid.level(1, face)), side, rtol=0.01)


@pytest.mark.parametrize("warp", [*VOLUMES, ir.CubicSpline()], ids=repr)
def test_harmonics_are_of_directions_in_the_world(warp):
    ahead = towards(45, 20)
    pyramid = filtered(ir.SphericalHarmonicVoxels(), screen(ahead), warp)
    texels = np.stack([pyramid.level(0, face) for face in range(4)], -2)
    seen = texels[texels[..., 0, 3] > 0][..., :3]
    mean, step = 0.5 * np.add(FRONT, BACK), 0.75 * np.subtract(FRONT, BACK)
    assert np.allclose(seen[:, 0], mean, rtol=2e-3)
    assert np.allclose(seen[:, 1:], ahead[:, None] * step, atol=2e-3)


def ground_light(technique, warp, ahead, sign):
    """Irradiance of the ground before a wall across the view, lit on its near (1) or its far side (-1): by cones, by rays."""
    right, up = np.cross(ahead, (0, 1, 0)), np.array((0, 1.0, 0))
    foot = 3.0 * ahead - (0, 0.5, 0)
    wall = quad([foot - right, foot + right, foot + right + up, foot - right + up], albedo=(0.8,) * 3)
    view = ir.Camera(position=(0, 0, 0), target=tuple(ahead - (0, 0.15, 0)), fov_x=70)
    sun = ir.DirectionalLight(direction=tuple(sign * ahead), irradiance=(1,) * 3)  # along the ground
    scene = scene_of(floor(height=-0.5, half=5.0, albedo=(0.0,) * 3), wall, lights=[sun], cameras={"view": view})
    gbuffer, pyramid = ir.trace_gbuffer(scene, "view", SIZE), filtered(technique, scene, warp, 64)
    before = (np.abs(gbuffer.position[..., 1] + 0.5) < 1e-3) & (np.abs(gbuffer.position @ ahead - 2.5) < 0.3)
    before &= np.abs(gbuffer.position @ right) < 0.5
    return [ir.march(march, pyramid, gbuffer, scene, seed=1).irradiance[before].mean()
            for march in (ir.DiffuseCones(level_bias=-1), ir.TracedRays(samples=256))]  # fmt: skip


@pytest.mark.parametrize("technique", [ir.OctantCoverage(), ir.Anisotropic(), ir.SphericalHarmonicVoxels()], ids=repr)
def test_ground_before_a_screen_sees_its_near_side_only(technique):
    ahead = towards(40, 0)
    cones, rays = ground_light(technique, ir.Linear(), ahead, 1)
    plain = cones / rays  # filters blur the wall's light towards the ground
    for warp in (ir.CubicSpline(), ir.Logistic(), ir.Perspective(), ir.Spherical()):
        cones, rays = ground_light(technique, warp, ahead, 1)
        assert 0.9 < cones / rays < 1.05 * plain
        assert ground_light(technique, warp, ahead, -1)[0] < 0.2 * cones
