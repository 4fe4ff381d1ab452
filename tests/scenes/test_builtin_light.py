"""The built-in scenes as rays see them: nothing shows through walls, and dark rooms are dark."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect as ir

INSIDE = [  # scene, its knobs: closed rooms
    ("furnace", {}), ("furnace", {"shape": "sphere"}), ("integrating_sphere", {}), ("textured_light_box", {}),
    ("thin_wall", {"rotation": 30}), ("dark_room", {"thickness": 0.005, "rotation": 30}), ("corridors", {}),
]  # fmt: skip


@pytest.mark.parametrize(("name", "knobs"), INSIDE)
def test_no_ray_leaves_a_closed_room(name, knobs):
    scene = getattr(ir.scenes, name)(**knobs)
    for camera in scene.cameras:
        view = scene.cameras[camera]
        for target in (view.target, 2 * np.array(view.position) - view.target):  # before and behind
            turned = ir.Camera(position=view.position, target=target, fov_x=100)
            assert np.isfinite(ir.trace_gbuffer(scene, turned, (120, 90)).depth).all(), camera


@pytest.mark.parametrize("detail", [5_000, 60_000])
def test_no_ray_leaves_the_atrium_but_upwards(detail):
    scene = ir.scenes.atrium(detail)
    for position in ((0, 1.7, 0.9), (-4.8, 1.5, 4.6), (5.0, 6.6, -4.8)):  # court, aisle, gallery
        for x, z in ((1, 0), (0, 1), (-1, 0), (0, -1), (0.7, 0.7)):
            target = (position[0] + x, position[1] - 0.3, position[2] + z)
            # 41 degrees each way around 17 below the horizon: at most 24 above it, below the walls' top from everywhere inside
            view = ir.Camera(position=position, target=target, fov_x=82)
            assert np.isfinite(ir.trace_gbuffer(scene, view, (160, 90)).depth).all(), (position, target)
    down = ir.Camera(position=(0.3, 8, 0.2), target=(0.3, 0, 0.2), up=(1, 0, 0), fov_x=100)
    assert np.isfinite(ir.trace_gbuffer(scene, down, (160, 160)).depth).all()


@pytest.mark.parametrize(
    ("name", "knobs"),
    [("thin_wall", {}), ("thin_wall", {"thickness": 1e-3, "rotation": 37, "offset": 0.03}), ("corridors", {"thickness": 0.02})],
)
def test_the_truth_of_a_dark_room_is_exactly_zero(name, knobs):
    scene = getattr(ir.scenes, name)(**knobs)
    method = ir.methods.PathTracing(spp=4, bounces=4)
    assert method.render(scene, camera="dark", size=(48, 48)).image.max() == 0
    assert method.render(scene, camera="lit", size=(48, 48)).image.min() > 0


@pytest.mark.parametrize(("light", "share"), [("area", 0.1), ("point", 0.1), ("spot", 0.3)])
def test_light_in_the_cornell_box_takes_the_colour_of_the_walls(light, share):
    scene = ir.scenes.cornell_box(light)
    frame = ir.methods.PathTracing(spp=8, bounces=2).render(scene, size=(64, 64))
    assert frame.indirect.mean() > share * frame.image.mean()
    red, green = frame.indirect[20:28, 14:17].mean((0, 1)), frame.indirect[20:28, 47:50].mean((0, 1))  # back wall beside each
    assert red[0] / red[1] > green[0] / green[1]


def test_the_grille_is_about_a_pixel_wide_where_its_page_says_so():
    scene = ir.scenes.grille(width=0.004)
    gbuffer = ir.trace_gbuffer(scene, "front", (1280, 720))
    iron = np.abs(np.asarray(gbuffer.albedo)[360] - (0.08, 0.08, 0.09)).max(1) < 1e-3
    starts = np.flatnonzero(np.diff(np.r_[0, iron.astype(int)]) == 1)
    assert 10 <= len(starts) <= 24  # upright bars across the middle row
    assert 0.5 < iron.sum() / len(starts) < 3


def test_shorter_leaves_cover_as_much_of_the_picture():
    shares = []
    for length in (0.1, 0.03):
        albedo = np.asarray(ir.trace_gbuffer(ir.scenes.foliage(length), size=(320, 240)).albedo)
        shares.append((albedo[..., 1] > 2 * albedo[..., 2] + 0.05).mean())
    assert shares[0] == pytest.approx(shares[1], rel=0.1) and 0.1 < shares[1] < 0.4


def test_leaves_are_cut_out_by_their_mask():
    leaf = ir.scenes.foliage().meshes[-1].material.mask
    assert leaf.solid.mean() == pytest.approx(np.pi / 4, abs=0.03)


def test_a_wire_is_about_a_pixel_wide_where_its_page_says_so():
    scene = ir.scenes.wires(width=0.004)
    hit = np.isfinite(ir.trace_gbuffer(scene, size=(1280, 720)).depth)
    runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[False], hit[:, 640], [False]]).astype(int))))[::2]
    assert 1 <= np.median(runs) <= 2 and len(runs) > 10
    assert hit.mean() < 0.1 and not np.isfinite(ir.trace_gbuffer(scene, size=(64, 36)).depth).all(1).any()  # sky between all of them


def test_the_board_is_one_edge_in_depth_and_gets_indirect_light_alone():
    scene = ir.scenes.depth_edge()
    depth = np.asarray(ir.trace_gbuffer(scene, size=(64, 48)).depth)
    assert (depth[:40, 33:].min() - depth[:40, :30].max()) > 1.5  # above the board's foot, the wall lies two metres behind
    frame = ir.methods.PathTracing(spp=256, bounces=1).render(scene, size=(64, 48))
    board, room = np.s_[8:40, :30], np.s_[8:40, 34:]
    assert frame.direct[board].max() == 0 and frame.direct[room].min() > 0
    assert 0.1 * frame.image.mean() < 2 * frame.indirect[board].mean() < frame.indirect[room].mean()


def test_the_underside_of_a_ball_in_the_sky_has_the_floors_colour_and_the_sky_is_black():
    scene = ir.scenes.ball_in_sky(0.05)
    hit = np.isfinite(ir.trace_gbuffer(scene, size=(96, 72)).depth)
    frame = ir.methods.PathTracing(spp=64, bounces=0).render(scene, size=(96, 72))
    assert 0.002 < hit.mean() < 0.02 and frame.image[~hit].max() == 0
    bottom = ir.methods.PathTracing(spp=256, bounces=1).render(scene, size=(96, 72)).indirect[hit]
    assert bottom.mean(0)[0] / bottom.mean(0)[2] == pytest.approx(0.7 / 0.3, rel=0.02)
