"""Radiance per voxel in two bands, against numeric projection."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import floor, scene_of

import interreflect as ir
from interreflect import _core

DOWN = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(np.pi, 2, 1))
UP = ir.DirectionalLight(direction=(0, 1, 0), irradiance=(0.5, 1, np.pi))


def turned(angle, axis):
    """A rotation by `angle` (degrees) about one of the axes x, y, z, as a 4 x 4 matrix."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    matrix = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix[i, i], matrix[i, j], matrix[j, i], matrix[j, j] = c, -s, s, c
    return matrix


def directions(count=20_000):
    """As good as evenly spread over the sphere: a spiral by the golden ratio."""
    z = 1 - (2 * np.arange(count) + 1) / count
    phi = np.arange(count) * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], 1)


def harmonics(pyramid, level):
    """(z, y, x, 4 functions, RGBA)."""
    return np.stack([pyramid.level(level, face) for face in range(4)], -2)


def lit_of(scene, domain=None, both_sides=True, resolution=16):
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, domain or ir.Grid(resolution=resolution).place(scene))
    return ir.light_voxels(ir.TracedLighting(both_sides=both_sides), scene, voxels, 0)


@pytest.mark.parametrize("turn", [(0, 0), (25, 0), (50, 2), (-65, 0)])
def test_a_voxel_holds_the_numeric_projection_of_its_two_sides(turn):
    sheet = floor(albedo=(0.5, 0.4, 0.3)).replace(transform=turned(*turn))
    lit = lit_of(scene_of(sheet, lights=[DOWN, UP]))
    pyramid, way = ir.prefilter(ir.SphericalHarmonicVoxels(), lit), directions()
    normal = (turned(*turn) @ (0, 1, 0, 0))[:3]
    front, back = lit.radiance[0], lit.back[0]
    assert front.min() > 0 and back.min() > 0 and not np.allclose(front, back)
    looks = np.where((way @ normal < 0)[:, None], front, back)
    want = np.linalg.lstsq(np.concatenate([np.ones((len(way), 1)), way], 1), looks, rcond=None)[0]
    texels = harmonics(pyramid, 0)
    seen = texels[texels[..., 0, 3] > 0]
    assert len(seen) == len(lit.voxels)
    # Half floats, and 2e4 directions on a step.
    assert np.allclose(seen[..., :3], want, atol=2e-3 * front.max())
    assert (seen[:, 0, 3] == 1).all() and not seen[:, 1:, 3].any()


def test_either_side_keeps_its_flux_at_every_level():
    pyramid = ir.prefilter(ir.SphericalHarmonicVoxels(), lit_of(scene_of(floor(0.01, albedo=(0.5,) * 3), lights=[DOWN, UP]), resolution=16))
    way = directions()
    functions = np.concatenate([np.ones((len(way), 1)), way], 1)
    front, back = np.array([np.pi, 2, 1]) * 0.5 / np.pi, np.array([0.5, 1, np.pi]) * 0.5 / np.pi
    for level in range(pyramid.levels):
        texels = harmonics(pyramid, level)
        for texel in texels[texels[..., 0, 3] > 0][:50]:
            looks = functions @ texel[:, :3] / texel[0, 3]
            for side, radiance in ((way[:, 1] < 0, front), (way[:, 1] > 0, back)):
                cosine = np.abs(way[side, 1])[:, None]
                flux = (looks[side] * cosine).sum(0) / cosine.sum()  # over pi
                assert np.allclose(flux, radiance, rtol=0.01)  # half floats, once a level


def test_opacity_is_that_of_surface_coverage():
    lit = lit_of(ir.scenes.cornell_box(), resolution=40)
    ours, plain = ir.prefilter(ir.SphericalHarmonicVoxels(), lit), ir.prefilter(ir.SurfaceCoverage(), lit)
    for i in range(plain.levels):
        assert np.array_equal(ours.level(i)[..., 3], plain.level(i)[..., 3])


def test_sides_lit_alike_look_as_under_surface_coverage():
    lit = lit_of(ir.scenes.cornell_box(), both_sides=False, resolution=40)
    ours, plain = ir.prefilter(ir.SphericalHarmonicVoxels(), lit), ir.prefilter(ir.SurfaceCoverage(), lit)
    for i in range(plain.levels):
        assert np.array_equal(ours.level(i), plain.level(i))
        assert not any(ours.level(i, face).any() for face in (1, 2, 3))


def test_a_cone_sees_the_side_that_faces_it():
    # A sheet between two floors, red above and blue below: the lower floor receives blue, the ceiling red.
    middle = floor(0.0, half=4.0, albedo=(1, 1, 1))
    receivers = [
        floor(-1.0, half=4.0, albedo=(0.01,) * 3),
        floor(1.0, half=4.0, albedo=(0.01,) * 3).replace(transform=np.diag([1, -1, -1, 1.0])),
    ]
    red = ir.PointLight(position=(0, 0.4, 0), intensity=(1, 0, 0))
    blue = ir.PointLight(position=(0, -0.4, 0), intensity=(0, 0, 1))
    scene = scene_of(middle, receivers[0], lights=[red, blue])
    camera = ir.Camera(position=(0, -0.5, 0.3), target=(0, -1, 0), fov_x=40, up=(0, 0, 1))
    method = ir.methods.VoxelConeTracing(prefilter=ir.SphericalHarmonicVoxels(), grid=ir.Grid(resolution=64))
    red_, _, blue_ = method.prepare(scene.replace(cameras={"low": camera})).render("low", size=(16, 16)).indirect.mean((0, 1))
    assert blue_ > 0 and red_ < 0.1 * blue_  # the bands ring: what is left of the far side's light is clamped at 0
    plain = method.replace(prefilter=ir.SurfaceCoverage(), light_voxels=ir.TracedLighting())
    red_, _, blue_ = plain.prepare(scene.replace(cameras={"low": camera})).render("low", size=(16, 16)).indirect.mean((0, 1))
    assert red_ > blue_  # one radiance for both sides is the front's


@pytest.mark.parametrize("technique", _core.stages["prefilter"]["techniques"])
def test_cones_in_a_furnace_see_its_radiance_under_every_filter(technique):
    # A point light in the middle of a sphere: its wall reflects 1/2 everywhere (GROUND_TRUTH 3).
    furnace = ir.scenes.furnace(shape="sphere", albedo=0.5)
    radius = float(np.abs(furnace.bounds).max())
    meshes = [mesh.replace(material=ir.Material(albedo=(0.5,) * 3)) for mesh in furnace.meshes]
    scene = ir.Scene(meshes=meshes, lights=[ir.PointLight(position=(0, 0, 0), intensity=(np.pi * radius**2,) * 3)])
    camera = ir.Camera(position=(0, 0, 0), target=(1, 0.2, 0.1), fov_x=60)
    pyramid = ir.prefilter(technique(), lit_of(scene, resolution=64))
    gbuffer = ir.trace_gbuffer(scene.replace(cameras={"c": camera}), "c", (24, 24))
    gathered = ir.march(ir.DiffuseCones(), pyramid, gbuffer, scene, seed=1)
    # A sphere's wall faces a cone as the floor does that it left: what two bands show too much head on they lack at the rim, but for
    # the rim's nearest voxels, whose place is known to half a voxel. Sides are known to as much from octants.
    sided = technique in (ir.SphericalHarmonicVoxels, ir.Anisotropic, ir.OctantCoverage)
    assert gathered.irradiance.mean() / np.pi == pytest.approx(0.5 * gathered.occlusion.mean(), rel=0.1 if sided else 0.002)
    # A mean of eight thins the wall; the other filters keep it as closed as their staircases of voxels are.
    assert gathered.occlusion.mean() < 0.5 if technique is ir.VolumeCoverage else gathered.occlusion.mean() > 0.75
