"""Voxels whose light builds on the last frame's: blended, updated slab by slab, or with all bounces."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from voxel_scenes import box, floor, scene_of, soup

import interreflect as ir
from interreflect import _core
from interreflect.stability.response import response

SUN = ir.DirectionalLight(direction=(0, -1, 0), irradiance=(np.pi,) * 3)


def voxels_of(scene, domain=None, resolution=16):
    return ir.voxelize(ir.SurfaceSampling(), scene, domain or ir.Grid(resolution=resolution).place(scene))


def brighter(scene, factor):
    return scene.replace(lights=[ir.DirectionalLight(direction=SUN.direction, irradiance=(factor * np.pi,) * 3)])


@pytest.mark.parametrize("weight", [0.0, 0.25, 0.9, 1.0])
def test_radiance_is_weight_times_the_last_frames_plus_the_rest_of_the_new(weight):
    scene = scene_of(floor(albedo=(0.5,) * 3), lights=[SUN])
    voxels = voxels_of(scene)
    technique = ir.BlendHistory(weight=weight, light_voxels=ir.TracedLighting(both_sides=True))
    first = ir.light_voxels(technique, scene, voxels)
    assert np.allclose(first.radiance, 0.5, rtol=1e-5), "without history, the light is the technique's"
    second = ir.light_voxels(technique, brighter(scene, 3), voxels, history=first)
    assert np.allclose(second.radiance, weight * 0.5 + (1 - weight) * 1.5, rtol=1e-5)
    assert second.back.shape == first.back.shape


def test_history_stays_at_its_place_in_the_world_when_the_domain_moves_by_whole_voxels():
    scene = scene_of(*soup(7, 40), lights=[SUN])
    at = lambda x: _core.Domain(lower=[x, -3.0, -3.0], voxel_size=0.25, cells=[24, 24, 24])  # noqa: E731
    technique = ir.BlendHistory(weight=1.0)
    before = ir.light_voxels(technique, scene, voxels_of(scene, at(-3.0)))
    after = ir.light_voxels(technique, brighter(scene, 5), voxels_of(scene, at(-2.25)), history=before)
    place = {tuple(c): r for c, r in zip(before.voxels.coordinates, before.radiance, strict=True)}
    kept = [(place[(x + 3, y, z)], r) for (x, y, z), r in zip(after.voxels.coordinates, after.radiance, strict=True) if x + 3 < 24]
    assert len(kept) > 100 and all(np.array_equal(a, b) for a, b in kept)
    fresh = ir.light_voxels(ir.TracedLighting(), brighter(scene, 5), after.voxels)
    new = after.voxels.coordinates[:, 0] + 3 >= 24
    assert np.array_equal(after.radiance[new], fresh.radiance[new]), "what was outside is lit anew"


@pytest.mark.parametrize("slabs", [1, 3, 5])
def test_one_slab_a_frame_is_lit_and_after_as_many_frames_every_voxel_is(slabs):
    scene = scene_of(box((-1, -1, -1), (1, 1, 1)), floor(2, half=1.5), lights=[SUN])
    voxels = voxels_of(scene)
    technique = ir.BlendHistory(weight=0.0, slabs=slabs)
    dark = ir.light_voxels(technique, scene.replace(lights=[]), voxels)
    truth = ir.light_voxels(ir.TracedLighting(), scene, voxels).radiance
    lit, z, seen = dark, voxels.coordinates[:, 2], np.zeros(len(voxels), bool)
    for _ in range(slabs):
        last = lit
        lit = ir.light_voxels(technique, scene, voxels, history=last)
        changed = (lit.radiance != last.radiance).any(1)
        assert not (changed & seen).any() and lit.counts.asdict()["voxels"] < len(voxels) / slabs * 1.8 + 1
        assert np.ptp(z[changed]) <= voxels.domain.cells[2] / slabs
        seen |= changed
    assert np.array_equal(lit.radiance, truth)


@pytest.mark.parametrize(("technique", "frames", "lag"), [
    (ir.TracedLighting(both_sides=True), 0, 0.0),
    (ir.BlendHistory(weight=0.5, light_voxels=ir.TracedLighting(both_sides=True)), 5, 0.5),  # 2^-6 < 2 %
    (ir.BlendHistory(weight=0.0, slabs=4, light_voxels=ir.TracedLighting(both_sides=True)), 3, None),
])  # fmt: skip
def test_the_step_response_of_the_picture_is_that_of_the_voxels(technique, frames, lag):
    scene = ir.scenes.cornell_box("point")
    motion = ir.Motion.switched_light(factor=3, at=2, frames=24)
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=24), light_voxels=technique, glossy=None)
    found = response([frame.indirect.mean() for frame in method.prepare(scene).play(motion, size=(24, 18))], 2)
    assert found.overshoot < 0.02  # frames have seeds of their own, which only a picture with emitters could tell
    assert found.frames == frames
    if lag is not None:
        assert found.lag == pytest.approx(lag, abs=0.01)


def test_a_method_keeps_only_the_history_that_its_technique_looks_at():
    scene = ir.scenes.cornell_box("point")
    frame = lambda t: ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16), light_voxels=t).render(scene, size=(8, 8))  # noqa: E731
    assert frame(ir.TracedLighting(both_sides=True)).history is None
    blended = ir.BlendHistory(light_voxels=ir.TracedLighting(both_sides=True))
    assert isinstance(frame(blended).history, _core.LitVoxels)
    bounced = ir.Bounces(light_voxels=ir.TracedLighting(both_sides=True))
    for technique in (bounced, ir.BlendHistory(light_voxels=bounced)):
        assert isinstance(frame(technique).history, _core.Pyramid)
        assert ir.methods.VoxelConeTracing(light_voxels=technique).bounces is None
    assert ir.methods.VoxelConeTracing(light_voxels=blended).bounces == 1
    voxels = voxels_of(scene)
    with pytest.raises(ValueError, match="pyramid"):
        ir.light_voxels(bounced, scene, voxels, history=ir.light_voxels(bounced, scene, voxels))
    with pytest.raises(ValueError, match="other sides"):
        ir.light_voxels(blended, scene, voxels, history=ir.light_voxels(ir.TracedLighting(), scene, voxels))


@pytest.mark.parametrize("albedo", [0.5, 0.8])
def test_bounces_in_a_furnace_follow_the_geometric_series_frame_by_frame(albedo):
    # GROUND_TRUTH 1: emission 1 from every wall. Voxels lit by emitters alone hold rho; every frame adds a power of rho, and
    # rho / (1 - rho) is what they end at.
    scene = ir.scenes.furnace(shape="cube", albedo=albedo)
    voxels = voxels_of(scene, resolution=24)
    technique = ir.Bounces(light_voxels=ir.TracedLighting(samples=64))
    history, means = None, []
    for frame in range(12):
        lit = ir.light_voxels(technique, scene, voxels, seed=frame, history=history)
        history = ir.prefilter(ir.SurfaceCoverage(), lit)
        means.append(float(lit.radiance.mean()))
    series = np.cumsum(albedo ** np.arange(1, 13))
    # Cones find the walls around them closed to a few per cent; the error of one bounce is multiplied as the light is.
    assert means[0] == pytest.approx(albedo, rel=0.01)
    assert np.allclose(means, series, rtol=0.05)
    assert all(a < b for a, b in itertools.pairwise(means))
