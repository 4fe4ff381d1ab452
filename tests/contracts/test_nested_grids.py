"""Prefilters and marches in nested grids: every texel beside its plain counterpart, light beside finer and coarser plain grids."""

from __future__ import annotations

import numpy as np
import pytest
from tests.contracts.test_march import furnace, quick, room
from voxel_scenes import box, floor, scene_of, soup

import interreflect as ir
from interreflect import _core

FILTERS = ir.techniques("prefilter")
EVERY_FILTER = [*(cls() for cls in FILTERS), ir.SurfaceCoverage(kernel="tent"), ir.SurfaceCoverage(format="rgba8"),
                ir.SurfaceCoverage(opacity="columns"), ir.OctantCoverage(opacity="columns")]  # fmt: skip
SUN = ir.DirectionalLight(direction=(0.3, -1, 0.2), irradiance=(np.pi, 2, 1))
EYE = ir.Camera(position=(0.4, -0.3, 0.6), target=(-0.2, 0.1, 0.0), fov_x=70)
SIZE = (64, 48)


def lit_in(scene, domain, lighting=None, voxelize=None):
    return ir.light_voxels(lighting or ir.TracedLighting(both_sides=True), scene, ir.voxelize(voxelize or ir.ExactOverlap(), scene, domain))


def grid_alone(domain, k):
    """One of the nested grids, as a plain one."""
    lower = domain.to_world(np.zeros((1, 3), np.float32), cascade=k)[0]
    return _core.Domain(lower=[float(v) for v in lower], voxel_size=domain.voxel_size * 2**k, cells=domain.cells)


def finer_box(domain, k):
    """Slices (z, y, x) of grid k where grid k - 1 lies, and the same as a mask."""
    corners = grid_alone(domain, k).to_voxels(domain.to_world(np.array([[0, 0, 0], domain.cells], np.float32), cascade=k - 1))
    first, last = np.rint(corners).astype(int)
    assert np.abs(corners - np.rint(corners)).max() < 1e-3
    box_ = tuple(slice(first[axis], last[axis]) for axis in (2, 1, 0))
    mask = np.zeros(tuple(domain.cells)[::-1], bool)
    mask[box_] = True
    return box_, mask


def same(a, b):
    """Nearly all texels equal: points of a voxel are found in another grid's numbers, and a shadow's edge may lie between."""
    return (np.abs(a - b) <= 2e-3 * max(np.abs(b).max(), 1e-6)).all(-1).mean() > 0.995


@pytest.mark.parametrize("technique", EVERY_FILTER, ids=repr)
def test_levels_of_nested_grids_hold_their_own_voxels_and_what_finer_ones_filter_to(technique):
    scene = scene_of(*soup(4), lights=[SUN], cameras={"view": EYE})
    domain = ir.Grid(resolution=16, cascades=3).place(scene)
    pyramid = ir.prefilter(technique, lit_in(scene, domain))
    assert pyramid.levels == 3 + 4
    sizes = [tuple(pyramid.level(i).shape[:3]) for i in range(pyramid.levels)]
    assert sizes[:3] == [tuple(domain.cells)[::-1]] * 3 and sizes[-1] == (1, 1, 1)
    alone = [ir.prefilter(technique, lit_in(scene, grid_alone(domain, k))) for k in range(3)]
    for face in range(pyramid.faces):
        assert same(pyramid.level(0, face), alone[0].level(0, face))
        inner, _ = finer_box(domain, 1)
        assert same(pyramid.level(1, face)[inner], alone[0].level(1, face))
        for k in (1, 2):
            _, mask = finer_box(domain, k)
            own, plain = pyramid.level(k, face)[~mask], alone[k].level(0, face)[~mask]
            assert same(own[..., 3:], plain[..., 3:])  # six faces have no plain counterpart but for opacity
            if not isinstance(technique, ir.Anisotropic):
                assert same(own, plain)


def test_volume_coverage_keeps_the_energy_of_all_nested_grids():
    scene = scene_of(*soup(6), lights=[SUN], cameras={"view": EYE})
    for cascades in (2, 4):
        domain = ir.Grid(resolution=12, cascades=cascades).place(scene)
        pyramid = ir.prefilter(ir.VolumeCoverage(), lit_in(scene, domain))
        want = 0.0
        for k in range(cascades):
            texels = pyramid.level(k).astype(np.float64)
            own = texels[~finer_box(domain, k)[1]] if k else texels.reshape(-1, 4)
            want = want + own.sum(0) * 8.0**k
        for i in range(cascades - 1, pyramid.levels):
            total = pyramid.level(i).astype(np.float64).sum((0, 1, 2)) * 8.0**i
            assert np.allclose(total, want, rtol=2e-3)  # a rounding of 2^-11 a level


def test_six_faces_of_a_coarse_grid_show_the_side_they_look_at():
    sheet = floor(half=3.0, height=-1.3, albedo=(0.5,) * 3)
    eye = ir.Camera(position=(0.0, 1.0, 0.0), target=(0.5, 0.0, 0.1), fov_x=60)
    scene = scene_of(sheet, box((-3, -3, -3), (3, 3, 3), inward=True), lights=[ir.PointLight(position=(0, 1.5, 0), intensity=(9,) * 3)],
                     cameras={"view": eye})  # fmt: skip
    domain = ir.Grid(resolution=16, cascades=2).place(scene)
    pyramid = ir.prefilter(ir.Anisotropic(), lit_in(scene, domain))
    y = int(domain.to_voxels(np.array([[2.8, -1.3, 2.8]], np.float32))[0, 1])
    below, above = (pyramid.level(1, face)[2, y, 1:3] for face in (2, 3))
    assert (below[..., 3] == 1).all() and (above[..., 3] == 1).all()
    assert below[..., :3].max() == 0 and above[..., :3].min() > 0


@pytest.mark.parametrize("technique", FILTERS)
def test_fewer_levels_than_nested_grids_are_refused(technique):
    scene = scene_of(*soup(4), lights=[SUN], cameras={"view": EYE})
    lit = lit_in(scene, ir.Grid(resolution=8, cascades=3).place(scene))
    with pytest.raises(ValueError, match="levels is 2, but each of 3 nested grids is a level"):
        ir.prefilter(technique(levels=2), lit)
    assert ir.prefilter(technique(levels=3), lit).levels == 3


@pytest.mark.parametrize(("technique", "cells"), [(ir.OctantCoverage(), 1024), (ir.SurfaceCoverage(), 1024), (ir.OctantCoverage(), 512)])
def test_a_pyramid_beyond_the_memory_cap_is_refused_with_its_bytes(technique, cells):
    scene = scene_of(floor(half=0.01), lights=[SUN])
    domain = _core.Domain(lower=[0.0, -0.5, 0.0], voxel_size=1.0, cells=[cells] * 3)
    sizes, volumes = [cells >> i for i in range(cells.bit_length())], 8 if isinstance(technique, ir.OctantCoverage) else 1
    with pytest.raises(ValueError, match=f"would need {sum((n + 2) ** 3 for n in sizes) * volumes * 8} bytes"):
        ir.prefilter(technique.replace(dense_limit=131072), lit_in(scene, domain, voxelize=ir.SurfaceSampling()))


def gathered(scene, grid, technique=None, prefilter=None, stage="march"):
    """The G-buffer and the light that a technique gathers from the voxels of a grid about the scene's camera."""
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    lit = lit_in(scene, grid.place(scene, "view", SIZE), voxelize=ir.SurfaceSampling())
    pyramid = ir.prefilter(prefilter or ir.OctantCoverage(), lit)
    return gbuffer, getattr(ir, stage)(technique or ir.DiffuseCones(), pyramid, gbuffer, scene, seed=1)


# Without the tent, whose second level is blurred beyond voxels of that size: far light differs by more than near light gains.
@pytest.mark.parametrize("prefilter", [f for f in EVERY_FILTER if getattr(f, "kernel", "box") == "box"], ids=repr)
def test_near_the_camera_nested_grids_gather_what_a_grid_of_their_finest_voxels_does(prefilter):
    # The camera looks at the foot of the block from 0.35 away: the finest grid reaches 0.5 from it.
    view, full = ir.Camera(position=(0.2, 0.3, 0.4), target=(-0.05, 0, 0.1), fov_x=70), room()
    scene = ir.Scene(meshes=full.meshes, lights=full.lights, cameras={"view": view})
    nested_grid = ir.Grid(resolution=32, cascades=2)
    gbuffer, fine = gathered(scene, ir.Grid(resolution=64), prefilter=prefilter)
    _, nested = gathered(scene, nested_grid, prefilter=prefilter)
    _, coarse = gathered(scene, ir.Grid(resolution=32), prefilter=prefilter)
    near = nested_grid.place(scene, "view", SIZE)
    inside = np.abs(gbuffer.position - np.array(view.position)).max(-1) < 14 * near.voxel_size
    assert inside.mean() > 0.5

    def error(light):
        return np.abs(light.irradiance[inside] - fine.irradiance[inside]).mean() / fine.irradiance[inside].mean()

    # Far light is as coarse in both; under volume coverage it is most of the error, as walls thin out with every level.
    assert error(nested) < (1 if isinstance(prefilter, ir.VolumeCoverage) else 0.9) * error(coarse)
    assert nested.irradiance.mean() == pytest.approx(coarse.irradiance.mean(), rel=0.05)


@pytest.mark.parametrize("cls", ir.techniques("march"))
@pytest.mark.parametrize("cascades", [2, 3])
def test_a_uniform_world_stays_uniform_in_nested_grids(cls, cascades):
    scene = furnace()
    lit = lit_in(scene, ir.Grid(resolution=16, cascades=cascades).place(scene), ir.TracedLighting(samples=256), ir.SurfaceSampling())
    light = ir.march(quick(cls), ir.prefilter(ir.SurfaceCoverage(), lit), ir.trace_gbuffer(scene, "view", SIZE), scene, seed=1)
    # As in a plain grid: at most 7 % are lost between layers of voxels and at the room's edges.
    assert light.irradiance.mean() == pytest.approx(0.5 * np.pi, rel=0.07)
    assert light.occlusion.mean() > 0.93


def test_rays_see_in_nested_grids_what_they_see_in_a_plain_one():
    scene, rays = room(), ir.TracedRays(samples=256)
    _, plain = gathered(scene, ir.Grid(resolution=64), rays)
    _, nested = gathered(scene, ir.Grid(resolution=32, cascades=2), rays)
    # The same rays; what they hit is lit in voxels of one size or twice that.
    assert nested.irradiance.mean() == pytest.approx(plain.irradiance.mean(), rel=0.03)
    assert np.abs(nested.irradiance - plain.irradiance).mean() < 0.06 * plain.irradiance.mean()


@pytest.mark.parametrize("cls", ir.techniques("glossy"))
def test_glossy_light_of_nested_grids_is_that_of_a_plain_one(cls):
    scene = room(specular=(0.3,) * 3, roughness=0.4)
    _, fine = gathered(scene, ir.Grid(resolution=64), quick(cls), stage="glossy")
    _, nested = gathered(scene, ir.Grid(resolution=32, cascades=2), quick(cls), stage="glossy")
    assert nested.radiance.mean() == pytest.approx(fine.radiance.mean(), rel=0.1)


def test_nothing_is_occluded_above_an_infinite_plane_in_nested_grids():
    plane = floor(half=5.0, albedo=(0.5,) * 3)
    view = ir.Camera(position=(0, 1, 0), target=(0.5, 0, 0.5), fov_x=60)
    scene = scene_of(plane, lights=[ir.EnvironmentLight(radiance=(1.0, 2.0, 3.0))], cameras={"view": view})
    _, light = gathered(scene, ir.Grid(resolution=32, cascades=3), prefilter=ir.SurfaceCoverage())
    assert abs(light.occlusion).max() < 0.02
    np.testing.assert_allclose(light.sky, np.broadcast_to(np.pi * np.array([1.0, 2.0, 3.0]), light.sky.shape), rtol=0.02)


def test_light_has_no_step_where_nested_grids_meet():
    """Along a floor that is lit by a wall: the largest change from pixel to pixel is no larger than in a plain grid."""
    ground = floor(half=4.0, albedo=(0.0,) * 3)
    wall = box((-4, 0, -4.2), (4, 3, -4), material=ir.Material(albedo=(0.8,) * 3))
    view = ir.Camera(position=(0.1, 0.5, 0.1), target=(0.1, 0.0, -1.5), fov_x=100)
    lamp = ir.DirectionalLight(direction=(0, -0.2, -1), irradiance=(1,) * 3)
    scene = scene_of(ground, wall, lights=[lamp], cameras={"view": view})
    steps = {}
    for name, grid in {"plain": ir.Grid(resolution=64), "nested": ir.Grid(resolution=32, cascades=3)}.items():
        gbuffer, light = gathered(scene, grid, ir.DiffuseCones(cones=32))
        seen = (np.abs(gbuffer.position[..., 1]) < 1e-3) & (gbuffer.position[..., 2] > -3.0) & np.isfinite(gbuffer.depth)
        value = np.where(seen, light.irradiance[..., 0], np.nan)
        steps[name] = np.nanmax(np.abs(np.diff(value, axis=0))) / np.nanmean(value)
    assert steps["nested"] < 1.5 * steps["plain"] + 0.02


@pytest.mark.parametrize(
    "changes",
    [{}, {"march": ir.TracedRays(samples=4)}, {"glossy": ir.TracedRays(samples=4)}, {"share": ir.EveryPixel()},
     *({"prefilter": cls()} for cls in FILTERS), {"voxelize": ir.ExactOverlap()}, {"light_voxels": ir.ShadowMapInjection(size=64)},
     {"light_voxels": ir.ConeLighting(both_sides=True)}, {"light_voxels": ir.Bounces()}, {"light_voxels": ir.BlendHistory(slabs=2)},
     {"shadow": ir.VoxelCones()}],
    ids=str,
)  # fmt: skip
def test_the_method_takes_any_technique_of_each_stage_in_nested_grids(changes):
    scene, frames = room(specular=(0.1,) * 3), []
    for grid in (ir.Grid(resolution=24), ir.Grid(resolution=48), ir.Grid(resolution=24, cascades=2)):
        prepared = ir.methods.VoxelConeTracing(grid=grid).replace(changes).prepare(scene)
        history = None
        for _ in range(3):
            frame = prepared.render(size=SIZE, history=history)
            history = frame.history
        frames.append(frame)
    coarse, fine, nested = frames
    assert np.isfinite(nested.image).all()
    # Between the plain grids of its coarsest and its finest voxels, within what grids laid elsewhere differ by.
    bounds = sorted([coarse.indirect.mean(), fine.indirect.mean()])
    assert 0.9 * bounds[0] < nested.indirect.mean() < 1.1 * bounds[1]
    assert nested.direct.mean() == pytest.approx(fine.direct.mean(), rel=0.1)


@pytest.mark.parametrize("prefilter", FILTERS)
def test_nested_grids_have_the_same_bits_at_any_thread_count(prefilter):
    scene, pictures = room(), []
    for threads in (1, 2):
        with _core.Threads(threads):
            pictures.append(gathered(scene, ir.Grid(resolution=16, cascades=3), prefilter=prefilter())[1].irradiance.copy())
    assert np.array_equal(*pictures)
