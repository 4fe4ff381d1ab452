"""Voxels drawn as cubes: which faces, in which colours, where."""

import numpy as np
import pytest

import interreflect as ir
from interreflect.cubes import exposed_faces

CAMERA = ir.Camera(position=(2.0, 2.0, 10.0), target=(2.0, 2.0, 0.0), fov_x=60)


def square(z, albedo, lower=1.05, upper=1.95):
    """A square across the z axis that stays within one cell of `domain`."""
    corners = [(lower, lower, z), (upper, lower, z), (upper, upper, z), (lower, upper, z)]
    return ir.Mesh(corners, [(0, 1, 2), (0, 2, 3)], material=ir.Material(albedo=albedo))


def domain(cells=(4, 4, 4)):
    from interreflect import _core

    return _core.Domain(lower=(0, 0, 0), voxel_size=1.0, cells=cells)


def voxels_of(*meshes):
    return ir.voxelize(ir.ExactOverlap(), ir.Scene(meshes=list(meshes)), domain())


def test_a_cell_alone_shows_six_faces_and_two_neighbours_ten():
    assert len(exposed_faces(np.array([[3, 4, 5]]))[0]) == 6
    assert len(exposed_faces(np.array([[3, 4, 5], [3, 5, 5]]))[0]) == 10


def test_a_solid_block_shows_its_surface_only():
    block = np.stack(np.meshgrid(*[np.arange(5)] * 3), -1).reshape(-1, 3)
    owner, axis, side = exposed_faces(block)
    assert len(owner) == 6 * 25
    assert (block[owner, axis] == 4 * side).all()


def test_no_voxels_are_a_black_picture_at_infinity():
    view = ir.voxel_view(voxels_of(), CAMERA, (16, 9))
    assert view.faces == 0 and not view.image.any() and np.isinf(view.depth).all() and (view.cell == -1).all()


def test_a_cube_stands_where_its_cell_is():
    view = ir.voxel_view(voxels_of(square(2.5, (0.8, 0.4, 0.2))), CAMERA, (200, 200))
    assert view.faces == 6
    seen = np.isfinite(view.depth)
    # The face at z = 3 is 7 from the eye, 1 wide; the picture is 2 * 7 * tan 30 degrees wide there, so the face covers 24.7 pixels.
    rows, columns = np.nonzero(seen)
    wide = 200 / (2 * 7 * np.tan(np.pi / 6))
    assert abs(np.ptp(columns) + 1 - wide) <= 1 and abs(np.ptp(rows) + 1 - wide) <= 1
    assert columns.max() < 100 and rows.min() >= 100  # x and y from 1 to 2: left of the middle and below it
    assert view.depth[seen].min() == pytest.approx(np.linalg.norm([0, 0, 7]), rel=1e-2)
    assert (view.cell[seen] == (1, 1, 2)).all()


def test_a_face_has_its_voxels_colour_and_one_brightness():
    view = ir.voxel_view(voxels_of(square(2.5, (0.8, 0.4, 0.2))), CAMERA, (64, 64))
    shown = view.image[np.isfinite(view.depth)]
    assert np.ptp(shown, axis=0).max() < 1e-6  # float rounding: one face, one shade
    assert shown[0] / shown[0, 0] == pytest.approx([1, 0.5, 0.25], rel=1e-5)
    assert 0.4 * 0.8 <= shown[0, 0] <= 0.8


def test_the_nearer_of_two_voxels_hides_the_other():
    view = ir.voxel_view(voxels_of(square(0.5, (0, 0, 1)), square(2.5, (1, 0, 0))), CAMERA, (64, 64))
    assert view.faces == 12
    middle = view.image[view.cell[..., 2] == 2]
    assert len(middle) and (middle[:, 0] > 0).all() and not middle[:, 2].any()


def test_colours_of_the_caller_are_shown():
    voxels = voxels_of(square(2.5, (0.8, 0.4, 0.2)))
    view = ir.voxel_view(voxels, CAMERA, (64, 64), colours=np.array([[0.0, 1.0, 0.0]]))
    assert view.image[..., 1].any() and not view.image[..., [0, 2]].any()
    with pytest.raises(ValueError, match=r"\(1, 3\)"):
        ir.voxel_view(voxels, CAMERA, (64, 64), colours=np.zeros((2, 3)))


def test_lit_voxels_show_the_side_that_faces_the_camera():
    light = ir.DirectionalLight(direction=(0, 0, -1), irradiance=(1, 1, 1))
    scene = ir.Scene(meshes=[square(2.5, (0.5, 0.5, 0.5))], lights=[light])
    lit = ir.light_voxels(ir.TracedLighting(both_sides=True), scene, ir.voxelize(ir.ExactOverlap(), scene, domain()))
    behind = ir.Camera(position=(2.0, 2.0, -10.0), target=(2.0, 2.0, 0.0), fov_x=60)
    assert ir.voxel_view(lit, CAMERA, (64, 64)).image.max() > 0.1  # 0.5 / pi, shaded
    assert not ir.voxel_view(lit, behind, (64, 64)).image.any()


def test_a_level_of_the_pyramid_has_cubes_twice_as_wide():
    light = ir.DirectionalLight(direction=(0, 0, -1), irradiance=(1, 1, 1))
    scene = ir.Scene(meshes=[square(2.5, (0.5, 0.5, 0.5))], lights=[light])
    lit = ir.light_voxels(ir.TracedLighting(), scene, ir.voxelize(ir.ExactOverlap(), scene, domain()))
    pyramid = ir.prefilter(ir.VolumeCoverage(), lit)
    fine, coarse = (np.isfinite(ir.voxel_view(pyramid, CAMERA, (200, 200), level=level).depth) for level in (0, 1))
    # The cell's front is 7 from the eye, that of its parent (z from 2 to 4) 6: 2 * 7 / 6 as wide on the picture.
    assert np.sqrt(coarse.sum() / fine.sum()) == pytest.approx(2 * 7 / 6, rel=0.05)
    with pytest.raises(IndexError):
        ir.voxel_view(pyramid, CAMERA, level=9)


def test_other_values_are_refused():
    with pytest.raises(TypeError, match="VoxelGrid"):
        ir.voxel_view(ir.scenes.cornell_box(), CAMERA)


def test_a_warped_cell_is_drawn_where_its_corners_lie():
    """Cells of a view volume: the picture of one of its own eye shows them on the grid of its own columns and rows."""
    room = ir.scenes.cornell_box()
    camera = room.camera
    domain = ir.Grid(resolution=16, warp=ir.Perspective(far=3.0, widening=1.0)).place(room, camera, (64, 64))
    voxels = ir.voxelize(ir.ExactOverlap(), room, domain)
    view = ir.voxel_view(voxels, camera, (64, 64))
    seen = np.isfinite(view.depth)
    rows, columns = np.nonzero(seen)
    assert len(rows) > 1000
    # Axis by axis the cell's number says in which sixteenth of the picture it stands, whichever way the axis runs.
    across, down = view.cell[seen][:, 0], view.cell[seen][:, 1]
    for number, pixel in ((across, columns), (down, rows)):
        assert (np.minimum(abs(number - pixel * 16 // 64), abs(15 - number - pixel * 16 // 64)) == 0).mean() > 0.99


def test_nested_grids_are_drawn_each_with_its_own_voxels():
    room = ir.scenes.cornell_box()
    domain = ir.Grid(resolution=16, cascades=2).place(room, room.camera, (32, 32))
    voxels = ir.voxelize(ir.ExactOverlap(), room, domain)
    view = ir.voxel_view(voxels, room.camera, (32, 32))
    surface = ir.trace_gbuffer(room, room.camera, (32, 32)).depth
    seen = np.isfinite(surface)
    assert seen.mean() > 0.5
    # The surface lies in a voxel, so the first voxel is at most a diagonal of the coarsest behind it.
    assert (view.depth - surface)[seen].max() < 2 * domain.voxel_size * np.sqrt(3)
    assert set(np.unique(voxels.cell // 16**3)) == {0, 1}
