"""Which voxelization leaves holes, and what counts as one."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import floor, quad, scene_of

import interreflect as ir
from interreflect import _core

DOMAIN = _core.Domain(lower=[-1.0] * 3, voxel_size=1 / 16, cells=[32] * 3)


def triangles(seed, count=6):
    """Random triangles of all shapes, some of them slivers, half a domain long."""
    random = np.random.default_rng(seed)
    corners = random.uniform(-1, 1, (count, 3, 3))
    corners[::3, 2] = corners[::3, 0] + (corners[::3, 1] - corners[::3, 0]) * 0.4 + random.normal(size=(len(corners[::3]), 3)) * 0.05
    return scene_of(ir.Mesh(corners.reshape(-1, 3).astype(np.float32), np.arange(3 * count, dtype=np.uint32).reshape(-1, 3)))


def coverage(technique, scene, domain=DOMAIN):
    return ir.voxel_coverage(ir.voxelize(technique, scene, domain), ir.voxelize(ir.ExactOverlap(), scene, domain))


@pytest.mark.parametrize("seed", range(8))
def test_tessellation_without_limit_and_conservative_rasterization_leave_no_holes(seed):
    scene = triangles(seed)
    full = coverage(ir.Rasterization(conservative="full"), scene)
    assert full.exact > 800 and full.missing == 0 and full.holes == 0
    assert coverage(ir.Rasterization(samples=8, oversampling=2), scene).holes == 0
    assert coverage(ir.Tessellation(), scene).holes == 0
    assert coverage(ir.Tessellation(max_level=3), scene).holes == 0  # what exceeds the limit is split
    # The same test finds the holes that the paper's settings leave (claims F4 and F12).
    assert coverage(ir.Rasterization(samples=1), scene).missing > 0
    assert coverage(ir.Tessellation(max_level=8, split=False), scene).holes > 100


def test_small_triangles_that_miss_every_pixel_centre_leave_holes_that_more_samples_close():
    # A wall of slivers, each thinner than a pixel's distance from one centre to the next.
    random = np.random.default_rng(1)
    x = np.linspace(-0.9, 0.9, 200)
    strips = [quad([[a, -0.9, 0.01], [b, -0.9, 0.01], [b, 0.9, 0.01], [a, 0.9, 0.01]]) for a, b in zip(x[:-1:2], x[1::2], strict=True)]
    scene = scene_of(*[strips[i] for i in random.permutation(len(strips))])
    holes = [coverage(ir.Rasterization(samples=n), scene).missing for n in (1, 2, 4, 8)]
    assert holes[0] > holes[2] >= holes[3] and holes[0] > 100
    assert coverage(ir.Rasterization(conservative="full"), scene).missing == 0


def test_conservative_rasterization_adds_voxels_and_plain_rasterization_none():
    scene = triangles(3)
    full = coverage(ir.Rasterization(conservative="full"), scene)
    assert 0 < full.extra_share < 0.2
    for samples in (1, 2, 4, 8):
        assert coverage(ir.Rasterization(samples=samples), scene).extra == 0


def test_triangles_that_share_an_edge_and_an_axis_neither_overlap_nor_crack():
    # A fan around a point: area is neither lost nor counted twice, whole pixels being covered.
    around = np.array([[-0.5, 0, 0.5], [0.5, 0, 0.5], [0.5, 0, -0.5], [-0.5, 0, -0.5]], np.float32)
    corners = np.concatenate([around, [[0.123, 0, 0.041]]]).astype(np.float32)
    fan = ir.Mesh(corners, np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]], np.uint32))
    for samples in (1, 2, 4, 8):
        grid = ir.voxelize(ir.Rasterization(samples=samples), scene_of(fan), DOMAIN)
        # Sums of up to 32 quarters and eighths of a face: exact but for a few roundings.
        assert len(grid) == 16 * 16 and np.allclose(grid.area, 1, atol=1e-6)


@pytest.mark.parametrize(
    "technique", [ir.SurfaceSampling(), ir.Tessellation(), ir.Tessellation(split=False), ir.Rasterization(conservative="full")]
)
def test_voxels_hold_the_area_of_the_triangles(technique):
    scene = triangles(5)
    grid = ir.voxelize(technique, scene, DOMAIN)
    exact = ir.voxelize(ir.ExactOverlap(), scene, DOMAIN)
    # Touches below ExactOverlap's tolerance are left out: 1e-4 of a face each.
    assert grid.area.sum() == pytest.approx(exact.area.sum(), rel=1e-3)


def test_rasterized_area_is_right_in_the_mean():
    scene = triangles(5)
    exact = ir.voxelize(ir.ExactOverlap(), scene, DOMAIN).area.sum()
    # Samples on the border of six triangles, each a part of a pixel: about the square root of 600 of several thousand.
    assert ir.voxelize(ir.Rasterization(samples=8, oversampling=2), scene, DOMAIN).area.sum() == pytest.approx(exact, rel=0.01)


def test_a_wall_has_a_hole_only_where_light_gets_through():
    # A wall in two layers of voxels; one is taken away, then both.
    wall = scene_of(*[quad([[-1, -1, z], [1, -1, z], [1, 1, z], [-1, 1, z]]) for z in (0.03, 0.09)])
    exact = ir.voxelize(ir.ExactOverlap(), wall, DOMAIN)
    one = scene_of(quad([[-1, -1, 0.03], [1, -1, 0.03], [1, 1, 0.03], [-1, 1, 0.03]]))
    front = ir.voxel_coverage(ir.voxelize(ir.ExactOverlap(), one, DOMAIN), exact)
    assert (front.missing, front.holes, front.extra) == (1024, 0, 0)
    none = ir.voxel_coverage(ir.voxelize(ir.ExactOverlap(), ir.Scene(meshes=[]), DOMAIN), exact)
    assert (none.missing, none.holes, none.hole_share) == (2048, 2048, 1.0)


def test_grids_of_different_domains_are_not_compared():
    scene = scene_of(floor())
    a, b = (ir.voxelize(ir.ExactOverlap(), scene, ir.Grid(resolution=n).place(scene)) for n in (8, 9))
    with pytest.raises(ValueError, match="one domain"):
        ir.voxel_coverage(a, b)


def test_an_edge_has_no_gaps_with_its_length_over_the_voxel_size():
    # ERRATA: the outer level's numerator is the edge's length. Needles along random directions: their voxels touch one another.
    random = np.random.default_rng(2)
    for _ in range(200):
        a, b = random.uniform(-0.95, 0.95, (2, 3))
        needle = ir.Mesh(np.array([a, b, b + 1e-5], np.float32), np.array([[0, 1, 2]], np.uint32))
        grid = ir.voxelize(ir.Tessellation(spacing=1.0, split=False), scene_of(needle), DOMAIN)
        along = np.argsort((grid.coordinates @ (b - a)), kind="stable")
        assert np.abs(np.diff(grid.coordinates[along], axis=0)).max(initial=0) <= 1


def test_the_most_contrasting_colour_wins_where_the_largest_is_asked_for():
    grey = floor(0.0, albedo=(0.5, 0.5, 0.5))
    red = quad([[-1, 0, 1], [-0.2, 0, 1], [-0.2, 0, -1], [-1, 0, -1]], albedo=(0.9, 0.1, 0.1))
    for order in ((grey, red), (red, grey)):
        grid = ir.voxelize(ir.Rasterization(blend="max"), scene_of(*order), DOMAIN)
        left = grid.position[:, 0] < -0.25
        assert np.allclose(grid.albedo[left], (0.9, 0.1, 0.1)) and np.allclose(grid.albedo[~left & (grid.position[:, 0] > -0.1)], 0.5)


def test_samples_that_are_no_pattern_are_refused():
    with pytest.raises(ValueError, match=r"Rasterization\.samples must be 1, 2, 4 or 8, got 3"):
        ir.voxelize(ir.Rasterization(samples=3), scene_of(floor()), DOMAIN)


@pytest.mark.parametrize("technique", [ir.SurfaceSampling(), ir.Rasterization(), ir.Rasterization(conservative="full"), ir.Tessellation()])
def test_a_million_triangles_without_area_leave_no_voxel_and_one_huge_one_only_what_lies_inside(technique):
    points = np.random.default_rng(0).uniform(-1, 1, (1_000_000, 3)).astype(np.float32)
    flat = ir.Mesh(points, np.repeat(np.arange(1_000_000, dtype=np.uint32), 3).reshape(-1, 3))
    assert len(ir.voxelize(technique, scene_of(flat), DOMAIN)) == 0
    huge = ir.Mesh(np.array([[-4e3, 0.01, -4e3], [4e3, 0.01, -4e3], [0, 0.01, 4e3]], np.float32), np.array([[2, 1, 0]], np.uint32))
    grid = ir.voxelize(technique, scene_of(huge), DOMAIN)
    # At least the inner columns: at such coordinates single precision knows a place to a hundredth of a voxel.
    assert len(grid) == 32 * 32 and (grid.coordinates[:, 1] == 16).all()


def test_triangles_too_long_for_single_precision_are_refused():
    for technique in (ir.Rasterization(), ir.Rasterization(conservative="full"), ir.Tessellation()):
        with pytest.raises(ValueError, match="longer than 2\\^20 voxels"):
            ir.voxelize(technique, scene_of(floor()), _core.Domain(lower=[0.0] * 3, voxel_size=1e-9, cells=[16, 1, 16]))


@pytest.mark.parametrize(
    "technique",
    [
        ir.Rasterization(samples=1, oversampling=8),
        ir.Rasterization(samples=8, oversampling=8, conservative="full"),
        ir.Tessellation(spacing=1 / 16),
        ir.Tessellation(spacing=2.0, max_level=1),
        ir.Tessellation(spacing=2.0, max_level=1, split=False),
        ir.Tessellation(spacing=1 / 16, max_level=1024, split=False),
    ],
)
def test_the_extremes_of_the_knobs_work(technique):
    exact = ir.voxelize(ir.ExactOverlap(), triangles(7), DOMAIN)
    grid = ir.voxelize(technique, triangles(7), DOMAIN)
    assert 0 < len(grid) <= 1.2 * len(exact) and np.isfinite(grid.position).all()


def test_a_fragment_grid_of_the_voxels_resolution_cracks_where_the_warp_is_steep_and_tessellation_does_not():
    # Claim F9: a steep warp makes voxels narrower than the pixels near the camera; more pixels close the cracks.
    wall = scene_of(
        quad([[-1, -0.9, -0.7], [1, -1, -0.8], [1, 1, 0.7], [-1, 0.9, 0.8]]),
        cameras={"eye": ir.Camera(position=(0, 0, 0.6), target=(0, 0, 0), fov_x=60, size=(64, 64))},
    )
    domain = ir.Grid(resolution=48, warp=ir.CubicSpline(alpha=2.5)).place(wall)
    cracked = coverage(ir.Rasterization(), wall, domain)
    assert cracked.hole_share > 0.02
    assert coverage(ir.Rasterization(oversampling=3), wall, domain).holes == 0
    assert coverage(ir.Tessellation(), wall, domain).holes == 0
    # As printed, levels come of the uniform voxel size.
    assert coverage(ir.Tessellation(spacing=1.0, levels="uniform"), wall, domain).holes > 0


def test_nested_grids_are_covered_in_one_pass():
    scene = triangles(4).replace(cameras={"eye": ir.Camera(position=(0.1, 0.2, 0.6), target=(0, 0, 0), fov_x=60, size=(64, 64))})
    domain = ir.Grid(resolution=24, cascades=3).place(scene)
    for technique in (ir.Rasterization(samples=8, oversampling=2), ir.Tessellation(), ir.Tessellation(levels="uniform")):
        assert coverage(technique, scene, domain).holes == 0, technique
    assert coverage(ir.Rasterization(conservative="full"), scene, domain).missing_share < 0.01


@pytest.mark.parametrize("spacing", [0.5, 0.7])
def test_tessellated_slivers_leave_no_holes_and_keep_their_area(spacing):
    # Long triangles from a fiftieth of a voxel to a voxel wide, their tips anywhere along them.
    random = np.random.default_rng(5)
    voxel = 2 / 16
    start, along, across = (random.uniform(-0.8, 0.8, (60, 3)), random.normal(size=(60, 3)), random.normal(size=(60, 3)))
    along *= random.uniform(0.3, 1, (60, 1)) / np.linalg.norm(along, axis=1, keepdims=True)
    across -= along * ((across * along).sum(1) / (along * along).sum(1))[:, None]
    across *= voxel * np.geomspace(0.02, 1, 60)[:, None] / np.linalg.norm(across, axis=1, keepdims=True)
    corners = np.stack([start, start + along, start + along * random.uniform(0, 1, (60, 1)) + across], 1) * 0.5
    scene = scene_of(ir.Mesh(corners.reshape(-1, 3).astype(np.float32), np.arange(180, dtype=np.uint32).reshape(-1, 3)))
    technique = ir.Tessellation(spacing=spacing)
    assert coverage(technique, scene).holes == 0
    areas = [ir.voxelize(t, scene, DOMAIN).area.sum() for t in (technique, ir.ExactOverlap())]
    assert areas[1] > 10
    assert areas[0] == pytest.approx(areas[1], rel=1e-4)  # single precision, of thousands of parts
