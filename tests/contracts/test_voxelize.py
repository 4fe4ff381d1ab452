"""What every technique of `voxelize` owes."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from voxel_scenes import QUAD, box, floor, mapped, quad, scaled, scene_of, soup

import interreflect as ir
from interreflect import _core
from interreflect.scenes.texture import Mask

# Every technique as it comes, and knobs that choose other code.
TECHNIQUES = {cls.__name__: cls() for cls in _core.stages["voxelize"]["techniques"]}
KNOBS = {
    "Rasterization-full": ir.Rasterization(conservative="full"),
    "Rasterization-oversampled": ir.Rasterization(samples=8, oversampling=3),
    "Tessellation-fine": ir.Tessellation(spacing=0.25, max_level=16),
}


@pytest.fixture(params=[*TECHNIQUES, *KNOBS])
def technique(request):
    return {**TECHNIQUES, **KNOBS}[request.param]


def voxels_of(technique, scene, resolution=16, domain=None):
    return ir.voxelize(technique, scene, domain or ir.Grid(resolution=resolution).place(scene))


def moved_domain(domain, factor, offset):
    lower = np.asarray(domain.lower) * factor + offset
    return _core.Domain(lower=[float(v) for v in lower], voxel_size=domain.voxel_size * factor, cells=domain.cells)


def test_a_voxel_weighs_large_and_tiny_triangles_by_their_area(technique):
    # A red sheet of two triangles and a blue one of 3,200 meet in the middle of voxels.
    red = quad([[-2, 0.5, 2], [0, 0.5, 2], [0, 0.5, -2], [-2, 0.5, -2]], albedo=(0.8, 0, 0))
    x, z = np.meshgrid(np.linspace(0, 2, 41), np.linspace(-2, 2, 41))
    first = (np.arange(40)[:, None] * 41 + np.arange(40)).ravel()
    faces = np.concatenate([np.stack([first, first + 41, first + 42], 1), np.stack([first, first + 42, first + 1], 1)])
    corners = np.stack([x, np.full_like(x, 0.5), z], -1).reshape(-1, 3).astype(np.float32)
    blue = ir.Mesh(corners, faces.astype(np.uint32), material=ir.Material(albedo=(0, 0, 0.8)))
    domain = _core.Domain(lower=[-2.5, 0.0, -2.0], voxel_size=1.0, cells=[5, 1, 4])
    grid = voxels_of(technique, scene_of(red, blue), domain=domain)
    middle = grid.coordinates[:, 0] == 2
    assert middle.sum() == 4
    # Samples half a voxel apart or closer put up to an eighth of the red strip on the wrong side of a border.
    np.testing.assert_allclose(grid.albedo[middle], [[0.4, 0, 0.4]] * 4, atol=0.05)


def test_cells_come_once_in_ascending_order_inside_the_domain(technique):
    grid = voxels_of(technique, scene_of(*soup(1)), 24)
    cells = grid.cell.astype(np.int64)
    assert len(grid) == len(cells) > 100 and (np.diff(cells) > 0).all()
    assert cells[-1] < np.prod(grid.domain.cells)
    x, y, z = grid.coordinates.T
    assert np.array_equal(x + grid.domain.cells[0] * (y + grid.domain.cells[1] * z), cells)
    assert grid.counts.asdict()["voxels"] == len(grid)


def test_every_mean_position_lies_in_its_voxel(technique):
    grid = voxels_of(technique, scene_of(*soup(2)), 24)
    local = (grid.position - grid.domain.lower) / grid.domain.voxel_size - grid.coordinates
    # 1e-4 voxel: rounding of world coordinates of about 2 at voxels of 1/6.
    assert local.min() > -1e-4 and local.max() < 1 + 1e-4


def test_mean_positions_and_normals_of_a_slanted_plane_lie_on_it(technique):
    # y = 0.3 x + 0.7 z: slopes differ, so that no two axes may be exchanged.
    slanted = quad([[x, 0.3 * x + 0.7 * z, z] for x, z in ((-1, 1), (1, 1), (1, -1), (-1, -1))])
    grid = voxels_of(technique, scene_of(slanted), 24)
    x, y, z = grid.position.T
    # Rounding of coordinates of 1, in voxels of 1/12; a sample's own place in its cell is exact.
    assert np.abs(y - 0.3 * x - 0.7 * z).max() < 1e-4 * grid.domain.voxel_size
    normal = np.array([-0.3, 1, -0.7]) / np.sqrt(0.09 + 1 + 0.49)
    assert np.allclose(grid.normal, normal, atol=1e-5)


def test_the_surface_of_a_cube_takes_the_outer_voxels(technique):
    # The outer walls lie half a voxel inside the domain, so they take the outermost voxels and no others.
    for n in (2, 5, 16):
        grid = voxels_of(technique, scene_of(box()), n)
        assert tuple(grid.domain.cells) == (n, n, n)
        shell = n**3 - max(n - 2, 0) ** 3
        edge = (grid.coordinates == 0) | (grid.coordinates == n - 1)
        assert edge.any(1).all()
        if isinstance(technique, ir.ExactOverlap):
            assert len(grid) == shell
        else:  # only the eight corners, of which each wall covers a quarter of a voxel's face, may be missed
            assert len(grid) >= shell - 8 and len(grid) - (edge.sum(1) == 3).sum() == shell - 8


def test_constant_albedo_in_gives_constant_albedo_out(technique):
    albedo = (0.2, 0.5, 0.8)
    meshes = [mesh.replace(material=ir.Material(albedo=albedo)) for mesh in soup(3)]
    grid = voxels_of(technique, scene_of(*meshes), 24)
    # A few additions of single precision.
    assert np.allclose(grid.albedo, albedo, rtol=1e-5)
    assert not grid.emission.any() and (grid.opacity == 1).all()


def test_emission_is_kept_apart_from_albedo(technique):
    grid = voxels_of(technique, scene_of(floor(0, albedo=(0.25,) * 3, emission=(3, 2, 1)), floor(2, albedo=(0.75,) * 3)), 8)
    low = grid.coordinates[:, 1] < grid.domain.cells[1] // 2
    assert np.allclose(grid.albedo[low], 0.25) and np.allclose(grid.albedo[~low], 0.75)
    assert np.allclose(grid.emission[low], (3, 2, 1), rtol=1e-5) and not grid.emission[~low].any()


def test_normals_are_unit_and_face_as_the_triangles_do(technique):
    grid = voxels_of(technique, scene_of(floor()), 9)
    assert np.allclose(grid.normal, (0, 1, 0), atol=1e-6)
    mirrored = scene_of(floor().replace(transform=np.diag([-1.0, 1, 1, 1])))
    assert np.allclose(voxels_of(technique, mirrored, 9).normal, (0, 1, 0), atol=1e-6)


def test_opposite_sides_in_one_voxel_leave_no_normal():
    turned = dataclasses.replace(floor(), triangles=QUAD[:, ::-1].copy())
    grid = voxels_of(ir.ExactOverlap(), scene_of(floor(), turned), 5)
    assert len(grid) == 25 and not grid.normal.any()


def test_masked_texels_are_air(technique):
    holes = Mask(np.array([[False, True]]))  # solid at u > 0.5: x > 0
    masked = scene_of(floor(mask=holes))
    # The mask's border lies 1e-3 voxel inside the ninth column: on the border of cells, rounding would choose a vertex's.
    placed = ir.Grid(resolution=16).place(masked)
    grid = voxels_of(technique, masked, domain=moved_domain(placed, 1, (-1e-3 * placed.voxel_size, 0, 0)))
    x = (grid.coordinates[:, 0] + 0.5) * grid.domain.voxel_size + grid.domain.lower[0]
    assert x.min() > 0 and 8 * 16 - 2 <= len(grid) <= 8 * 16  # the two corners hold a quarter of a face each
    # 17 voxels: the one in the middle is half solid, and the other half stays air.
    grid = voxels_of(technique, scene_of(floor(mask=holes)), 17)
    middle = grid.coordinates[:, 0] == 8
    # A row of 2 to 4 samples is cut in the middle; 16 points over each part of a triangle know a half to an eighth.
    assert 16 <= middle.sum() <= 17 and np.allclose(grid.opacity[middle].mean(), 0.5, atol=0.13)
    assert (grid.opacity[~middle] == 1).all()


def test_textures_are_averaged_over_the_voxel(technique):
    # Stripes finer than a voxel: every voxel sees their mean.
    stripes = ir.Texture(np.tile(np.array([[[0.0] * 3, [1.0] * 3]], np.float32), (512, 256, 1)))
    grid = voxels_of(technique, scene_of(floor(albedo_map=stripes)), 8)
    # At most 16 points in a part of a triangle; of stripes 0 and 1, unfiltered, they would know the mean to 0.125.
    assert np.allclose(grid.albedo, 0.5, atol=0.125) and abs(grid.albedo.mean() - 0.5) < 0.01
    half = ir.Texture(np.array([[[1.0, 0, 0], [0, 0, 1.0]]], np.float32).repeat(64, 1).repeat(64, 0))
    grid = voxels_of(technique, scene_of(floor(albedo_map=half)), 8)
    assert np.allclose(grid.albedo[grid.coordinates[:, 0] == 1], (1, 0, 0), atol=1e-3)
    assert np.allclose(grid.albedo[grid.coordinates[:, 0] == 6], (0, 0, 1), atol=1e-3)


def test_moved_and_rescaled_scenes_have_the_same_voxels(technique):
    scene = scene_of(*soup(4))
    plain = voxels_of(technique, scene, 24)
    same = voxels_of(technique, mapped(scene, scaled(4)), 24, moved_domain(plain.domain, 4, (0, 0, 0)))
    assert np.array_equal(plain.cell, same.cell) and np.array_equal(plain.albedo, same.albedo)  # powers of two are exact
    for factor, offset in ((1e-3, (0, 0, 0)), (1e3, (0, 0, 0)), (1, (200, -100, 50)), (7e-6, (0, 0, 0)), (3e8, (0, 0, 0))):
        matrix = scaled(factor, offset)
        other = voxels_of(technique, mapped(scene, matrix), 24, moved_domain(plain.domain, factor, offset))
        # Triangles that barely enter a cell may stay out by rounding (200 units away a voxel of 1/6 knows 1e-4 of itself).
        assert len(np.setxor1d(plain.cell, other.cell)) <= 0.01 * len(plain)
        a, b = np.isin(plain.cell, other.cell), np.isin(other.cell, plain.cell)
        assert np.median(np.abs(plain.albedo[a] - other.albedo[b])) < 1e-3


def test_the_same_bits_at_one_and_two_threads(technique):
    scene = ir.scenes.atrium(detail=5000)
    results = []
    for threads in (1, 2):
        with _core.Threads(threads):
            results.append(voxels_of(technique, scene, 48))
    for name in ("cell", "albedo", "normal", "emission", "position", "opacity"):
        assert np.array_equal(getattr(results[0], name), getattr(results[1], name)), name


def test_an_instance_has_the_voxels_of_its_triangles_in_the_world(technique):
    matrix = np.array([[0, -1, 0, 0.3], [1, 0, 0, -0.2], [0, 0, 1, 0.1], [0, 0, 0, 1]])
    part = box((-0.4, -0.3, -0.2), (0.5, 0.3, 0.4))
    room = box((-2, -2, -2), (2, 2, 2), inward=True)
    still = scene_of(room, part.replace(transform=matrix))
    body = scene_of(room, part.replace(body="part")).replace(bodies={"part": matrix})
    a, b = voxels_of(technique, still, 20), voxels_of(technique, body, 20)
    assert np.array_equal(a.cell, b.cell)
    assert np.allclose(a.normal, b.normal, atol=1e-5) and np.allclose(a.position, b.position, atol=1e-5)


def test_an_empty_and_a_flat_scene_work(technique):
    empty = voxels_of(technique, ir.Scene(meshes=[]), 16)
    assert len(empty) == 0 and empty.albedo.shape == (0, 3)
    flat = voxels_of(technique, scene_of(floor()), 16)
    assert tuple(flat.domain.cells) == (16, 1, 16) and 252 <= len(flat) <= 256  # the four corners hold a quarter of a face each


def test_what_lies_outside_the_domain_is_left_out(technique):
    scene = scene_of(*soup(5))
    whole = ir.Grid(resolution=16).place(scene)
    part = _core.Domain(lower=whole.lower, voxel_size=whole.voxel_size, cells=[8, 9, 7])
    every, some = voxels_of(technique, scene, domain=whole), voxels_of(technique, scene, domain=part)
    inside = (every.coordinates < (8, 9, 7)).all(1)
    assert np.array_equal(every.coordinates[inside], some.coordinates)


def test_a_triangle_far_larger_than_the_domain_costs_only_what_lies_inside(technique):
    # A floor of 1e5 voxels a side through a domain of 16: its 256 voxels.
    domain = _core.Domain(lower=[0.0, -0.0004, 0.0], voxel_size=1e-3, cells=[16, 1, 16])
    grid = voxels_of(technique, scene_of(floor(half=50)), domain=domain)
    assert len(grid) == 256 and np.allclose(grid.normal, (0, 1, 0))


def test_voxels_too_small_for_the_scene_are_refused():
    domain = _core.Domain(lower=[0.0, 0.0, 0.0], voxel_size=1e-9, cells=[16, 1, 16])
    with pytest.raises(ValueError, match="longer than 2\\^20 voxels"):
        voxels_of(ir.SurfaceSampling(), scene_of(floor()), domain=domain)


@pytest.mark.parametrize("seed", range(4))
def test_samples_fall_into_cells_that_the_triangles_overlap_and_miss_fewer_as_they_get_denser(seed):
    scene = scene_of(*soup(seed, 30))
    exact = voxels_of(ir.ExactOverlap(), scene, 32)
    missed = []
    for spacing in (1.0, 0.5, 0.25, 0.0625):
        sampled = voxels_of(ir.SurfaceSampling(spacing=spacing), scene, 32)
        assert np.isin(sampled.cell, exact.cell).all()
        missed.append(1 - len(sampled) / len(exact))
    # A cell is missed where the triangle's part in it is smaller than the spacing: along edges, so in proportion to the spacing.
    assert missed == sorted(missed, reverse=True) and missed[-1] < missed[1] / 4


def test_both_average_to_the_same_albedo_and_normal():
    scene = scene_of(*soup(6, 30))
    exact, sampled = voxels_of(ir.ExactOverlap(), scene, 16), voxels_of(ir.SurfaceSampling(spacing=0.0625), scene, 16)
    a, b = np.isin(exact.cell, sampled.cell), np.isin(sampled.cell, exact.cell)
    # Samples 1/16 voxel apart: slivers in a cell are known to some per cent, whole crossings far better.
    assert np.median(np.abs(exact.albedo[a] - sampled.albedo[b])) < 1e-3
    assert np.abs(exact.albedo[a] - sampled.albedo[b]).mean() < 5e-3
    assert np.median(np.abs(exact.normal[a] - sampled.normal[b])) < 1e-2


def test_no_ray_slips_through_a_tilted_wall_of_samples():
    # The voxels of a plane at any angle must block every straight line across it, face neighbours only.
    random = np.random.default_rng(7)
    for _ in range(20):
        axis = np.linalg.qr(random.normal(size=(3, 3)))[0]
        u, v = axis[0] * 4, axis[1] * 4
        wall = scene_of(quad([-u - v, u - v, u + v, -u + v]))
        domain = _core.Domain(lower=[-1.0] * 3, voxel_size=2 / 16, cells=[16] * 3)
        solid = np.zeros((16, 16, 16), bool)
        x, y, z = voxels_of(ir.SurfaceSampling(), wall, domain=domain).coordinates.T
        solid[z, y, x] = True
        centres = -1 + (np.stack(np.meshgrid(*[np.arange(16)] * 3, indexing="ij"), -1)[..., ::-1] + 0.5) / 8
        above = centres @ axis[2] > 0
        for direction in range(3):
            a, b = np.moveaxis(above & ~solid, direction, 0), np.moveaxis(~above & ~solid, direction, 0)
            assert not (a[1:] & b[:-1]).any() and not (a[:-1] & b[1:]).any()


def test_grid_places_cubic_voxels_over_any_aspect():
    scene = scene_of(box((0, 0, 0), (8, 2, 3)))
    domain = ir.Grid(resolution=33).place(scene)
    assert tuple(domain.cells) == (33, 9, 13) and domain.voxel_size == pytest.approx(0.25)
    assert np.allclose(domain.lower, (-0.125, -0.125, -0.125)) and np.allclose(domain.upper, (8.125, 2.125, 3.125))
    assert ir.Grid(resolution=33).place(scene) == domain
    with pytest.raises(ValueError, match=r"Grid\.resolution must lie in \[2, 1024\] voxels, got 1"):
        ir.Grid(resolution=1)
    assert eval(repr(ir.Grid(resolution=7)), {name: getattr(ir, name) for name in ("Grid", "Linear", "SceneBounds")}) == ir.Grid(
        resolution=7
    )


def test_domains_refuse_what_is_not_a_box_of_voxels():
    for bad, word in (({"voxel_size": 0.0}, "voxel_size"), ({"cells": [0, 1, 1]}, "cells"), ({"lower": [0.0, np.nan, 0.0]}, "lower")):
        with pytest.raises(ValueError, match=word):
            _core.Domain(**{"lower": [0.0, 0.0, 0.0], "voxel_size": 1.0, "cells": [4, 4, 4], **bad})


def test_arrays_are_read_only_views_that_outlive_their_owner():
    grid = voxels_of(ir.SurfaceSampling(), scene_of(floor(), box()), 8)
    albedo = grid.albedo
    before = albedo.copy()
    del grid
    assert np.array_equal(albedo, before) and not albedo.flags.writeable
