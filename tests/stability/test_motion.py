"""Motion as a value, frames of it, and what temporal error says."""

import dataclasses

import numpy as np
import pytest
from remembering import Remembering

import interreflect as ir
from interreflect.stability.reprojection import origin, pixel_angle, project, surfaces
from interreflect.stability.temporal import compare

SIZE = (48, 36)
QUICK = ir.Reference(noise=0.05, max_spp=32)


def test_a_dolly_moves_the_camera_by_scene_units_or_voxels_a_frame():
    scene = ir.scenes.cornell_box("point")
    here = scene.camera
    _, there = ir.Motion.dolly("front", by=(0.1, 0, -0.2), frames=4).at(scene, 3)
    assert np.subtract(there.position, here.position) == pytest.approx((0.3, 0, -0.6))
    assert np.subtract(there.target, here.target) == pytest.approx((0.3, 0, -0.6))
    voxel = ir.Grid(resolution=64).place(scene).voxel_size
    _, there = ir.Motion.dolly(by=(0.25, 0, 0), voxels=64, frames=4).at(scene, 2)
    assert there.position[0] - here.position[0] == pytest.approx(0.5 * voxel)


def test_a_rotation_turns_the_view_about_up_and_keeps_the_place():
    scene = ir.scenes.cornell_box("point")
    _, there = ir.Motion.rotation(by=30, frames=4).at(scene, 3)
    assert there.position == scene.camera.position
    view = np.subtract(there.target, there.position)
    assert view / np.linalg.norm(view) == pytest.approx((-1, 0, 0), abs=1e-6)  # from -z by 90 degrees counter-clockwise seen from above


def test_lights_move_turn_and_are_switched():
    box = ir.scenes.cornell_box("spot")
    (light,) = box.lights
    moved, _ = ir.Motion.moving_light(by=(0, -0.1, 0), frames=3).at(box, 2)
    assert np.subtract(moved.lights[0].position, light.position) == pytest.approx((0, -0.2, 0))
    turned, _ = ir.Motion.turning_light(by=90, axis=(0, 1, 0), frames=3).at(box, 2)
    assert turned.lights[0].direction == pytest.approx(np.multiply(light.direction, (-1, 1, -1)))
    switched = ir.Motion.switched_light(factor=0.5, at=2, frames=4)
    assert switched.at(box, 1)[0].lights[0].intensity == light.intensity
    assert switched.at(box, 2)[0].lights[0].intensity == pytest.approx(np.multiply(light.intensity, 0.5))
    sky = ir.scenes.blocked_sky()
    assert ir.Motion.turning_light(by=15, frames=3).at(sky, 2)[0].lights[0].rotation == 30


def test_a_body_moves_and_turns_about_its_middle():
    scene = ir.scenes.textured_light_box()
    moved, _ = ir.Motion.moving_body("torus", by=(0.1, 0, 0), turn=90, frames=3).at(scene, 2)
    pose = moved.bodies["torus"]
    corners = next(mesh for mesh in scene.meshes if mesh.body == "torus").bounds(np.eye(4))
    middle = corners.mean(0)
    assert (pose @ [*middle, 1])[:3] == pytest.approx(np.add(middle, (0.2, 0, 0)), abs=1e-6)
    assert pose[:3, :3] == pytest.approx(np.diag([-1, 1, -1]), abs=1e-6)


WRONG = [
    ({"frames": 0}, "Motion.frames must be a whole number"),
    ({"frames": 2, "light_turn": 1}, "Motion.light must say which light"),
    ({"frames": 2, "body_by": (1, 0, 0)}, "Motion.body must say which body"),
    ({"frames": 2, "light": 0, "switch": (2, 1.0)}, r"Motion.switch\[0\]"),
]


@pytest.mark.parametrize(("knobs", "message"), WRONG)
def test_a_motion_that_makes_no_sense_is_refused(knobs, message):
    with pytest.raises(ValueError, match=message):
        ir.Motion(**knobs)


def test_what_the_scene_lacks_cannot_move():
    scene = ir.scenes.cornell_box("point")
    for motion, message in [
        (ir.Motion.moving_light(1, by=(1, 0, 0), frames=2), "Motion.light must name one of the scene's 1 lights, got 1"),
        (ir.Motion.turning_light(by=1, frames=2), "turns spots, directional lights and environments, got a PointLight"),
        (ir.Motion.moving_body("car", by=(1, 0, 0), frames=2), "Motion.body must name a body of the scene .it has none., got 'car'"),
    ]:
        with pytest.raises(ValueError, match=message):
            motion.at(scene, 1)


def test_a_pixels_surface_point_projects_to_its_centre():
    scene = ir.scenes.textured_light_box()
    seen = surfaces(scene, scene.camera, SIZE)
    x, y, in_front = project(scene.camera, seen.position, SIZE)
    columns, rows = np.meshgrid(np.arange(SIZE[0]), np.arange(SIZE[1]))
    assert in_front.all() and np.abs(x - columns).max() < 1e-3 and np.abs(y - rows).max() < 1e-3  # float32 positions


def test_surface_points_are_found_again_though_camera_and_body_moved():
    scene = ir.scenes.textured_light_box()
    motion = ir.Motion(frames=2, camera_by=(0.02, 0, 0), camera_turn=1, body="ball", body_by=(0.02, 0, 0), body_turn=5)
    (now, there), (before, here) = motion.at(scene, 1), motion.at(scene, 0)
    seen, earlier = surfaces(now, there, SIZE), surfaces(before, here, SIZE)
    way = origin(seen, earlier)
    back = earlier.poses[1] @ np.linalg.inv(seen.poses[1])
    ball = seen.body == 1
    assert ball.sum() > 50 and way.found[ball].mean() > 0.5 and way.found.mean() > 0.75
    wanted = seen.position.copy()
    wanted[ball] = wanted[ball] @ back[:3, :3].T + back[:3, 3]
    off = np.linalg.norm(way.fetch(earlier.position) - wanted, axis=-1) / (pixel_angle(here, SIZE) * np.maximum(seen.depth, 1e-9))
    # Between pixels a flat surface is exact; a ball 20 pixels wide bulges by at most (1/2)^2 / (2 * 10) of a pixel across, more at its rim.
    assert off[way.found & ~ball & (seen.body == 0)].max() < 0.2
    assert np.percentile(off[way.found & ball], 95) < 0.5


def test_history_is_passed_from_frame_to_frame_and_seeds_differ():
    scene = ir.scenes.cornell_box("point")
    still = ir.Motion.still(frames=3)
    frames = list(Remembering(share=0.5).prepare(scene).play(still, size=SIZE))
    assert frames[0].history is not None
    assert all(np.array_equal(frame.image, frames[0].image) for frame in frames)  # point lights have no noise
    noisy = list(ir.methods.PathTracing(spp=1).prepare(scene).play(still, size=SIZE, seed=7))
    assert noisy[0].history is None
    again = ir.methods.PathTracing(spp=1).render(scene, size=SIZE, seed=8)
    assert np.array_equal(noisy[1].image, again.image) and not np.array_equal(noisy[0].image, again.image)


def test_the_truth_itself_has_no_temporal_error_and_noise_has_what_was_added():
    scene, motion = ir.scenes.cornell_box("point"), ir.Motion.dolly(by=(0.3, 0.1, 0), voxels=64, frames=3)
    method = ir.methods.PathTracing(spp=1)
    views = [motion.at(scene, k) for k in range(3)]
    truths = [ir.reference(s.replace(cameras={"moving": c}), "moving", SIZE, 1, QUICK.noise, QUICK.max_spp) for s, c in views]
    blank = ir.Profile()

    def played(images):
        frames = [ir.Frame(image, np.zeros_like(image), blank) for image in images]
        return compare(frames, method, scene, motion, SIZE, QUICK)

    exact = played([truth.image for truth in truths])
    assert exact.max == 0 and exact.pops == 0 and exact.points > 2000
    scale = np.mean([truth.image.mean() for truth in truths])
    brighter = played([truth.image + np.float32(k * 0.2 * scale) for k, truth in enumerate(truths)])
    assert brighter.mean == pytest.approx(0.2, rel=1e-3) and brighter.pops == brighter.points
    biased = played([2 * truth.image for truth in truths])  # an error that stays is no temporal error on flat shades
    assert biased.mean < 0.2 and biased.table["relmse"].min() > 0.5


def test_a_dropped_body_motion_would_be_seen():
    # The ball carries its light with it: without its pose in the reprojection, its points would be compared with what was behind them.
    scene = ir.scenes.textured_light_box()
    motion = ir.Motion.moving_body("ball", by=(0.2, 0, 0), frames=2)
    (now, there), (before, here) = motion.at(scene, 1), motion.at(scene, 0)
    seen, earlier = surfaces(now, there, SIZE), surfaces(before, here, SIZE)
    ball = seen.body == 1
    assert origin(seen, earlier).found[ball].mean() > 0.3
    assert origin(dataclasses.replace(seen, poses=earlier.poses), earlier).found[ball].mean() < 0.2


def test_flicker_is_for_motions_in_which_nothing_moves():
    scene = ir.scenes.cornell_box("point")
    still = ir.stability.motion(ir.methods.PathTracing(spp=1), scene, ir.Motion.still(frames=4), SIZE, reference=QUICK)
    steady = ir.stability.motion(ir.methods.ConstantAmbient(), scene, ir.Motion.still(frames=4), SIZE, reference=QUICK)
    assert still.flicker > 0.1 and steady.flicker == 0 and steady.max < 1e-4  # bilinear weights are rounded
    assert np.isnan(ir.stability.motion(ir.methods.ConstantAmbient(), scene, ir.Motion.rotation(by=1, frames=2), SIZE).flicker)


@pytest.mark.parametrize(("share", "momentum", "frames", "overshoot"), [(1.0, 0.0, 0, 0.0), (0.5, 0.0, 5, 0.0), (0.3, 0.5, None, None)])
def test_a_step_response_tells_frames_to_settle_and_overshoot(share, momentum, frames, overshoot):
    # (1 - share)^n <= 2 % from n = 6 on, counted from the switch's own frame, which is the first: 5 frames after it.
    scene = ir.scenes.cornell_box("point")
    motion = ir.Motion.switched_light(factor=3, at=2, frames=40)
    method = Remembering(share=share, momentum=momentum)
    played = ir.stability.motion(method, scene, motion, (16, 12), reference=QUICK)
    if frames is not None:
        assert played.response.frames == frames
        assert played.response.overshoot == pytest.approx(overshoot, abs=1e-3)
        assert played.response.lag == pytest.approx(1 - share, abs=1e-3)
    else:  # x_n = x + share (1 - x) + momentum (x_n-1 - x_n-2): roots sqrt(.5) e^(+-i 31.9 degrees), underdamped
        assert played.response.overshoot > 0.005 and played.response.frames > 5
    assert "frames" in played.response.words


def test_charts_and_tables_of_motion_show_every_frame():
    scene = ir.scenes.cornell_box("point")
    played = ir.stability.motion(ir.methods.ConstantAmbient(), scene, ir.Motion.rotation(by=1, frames=3), SIZE, reference=QUICK)
    assert list(played.table.index) == [0, 1, 2] and np.isnan(played.table["temporal_mean"].iloc[0])
    assert len(played.filmstrip(3).axes) >= 9 and len(played.chart().axes) == 2
    assert "constant-ambient" in played._repr_html_()
