"""What a client sees without a page: layers, wishes, errors that leave the picture, a truth that refines, cameras there and back."""

import threading
import time

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core, metrics
from interreflect.images import tone_map
from interreflect.live import points, sheets
from interreflect.live.layers import CURVE
from interreflect.live.poses import Space
from interreflect.live.renderer import Client, Renderer
from interreflect.live.session import Session, Wish
from interreflect.live.shared import Shared
from interreflect.live.truth import RefiningTruth
from interreflect.stages import trace_gbuffer
from interreflect.study.reference import stream_seed

SIZE = (32, 24)
VOXELS = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16))
CACHES = ir.methods.ClusteredRadianceCaching(grid=ir.Grid(resolution=16), distribute=ir.Clustered(caches=32))
LIGHTS = ir.methods.VirtualAreaLights(map_size=16, emitter_views=2, sample_lights=ir.HaltonLights(lights=8))
SURFELS = ir.methods.IlluminanceComposition(place_surfels=ir.HaltonSurfels(surfels=512), place_caches=ir.CacheGrid(nx=4, ny=4, nz=4))


@pytest.fixture(scope="module")
def scene():
    return ir.scenes.cornell_box(light="point")


@pytest.fixture(scope="module")
def shared(scene):
    return Shared(scene)


@pytest.fixture
def session(shared, scene):
    return Session(shared, Wish(VOXELS, scene.camera, SIZE))


def test_light_layers_are_the_frames_light_at_one_exposure(session):
    image = session.step()
    frame = image.seen.frame
    stops = np.log2(metrics.MIDDLE_GREY / frame.image.mean(dtype=np.float64))
    for layer in ("image", "direct", "indirect"):
        session.change(layer=layer)
        picture = session.step()
        assert picture.seen is image.seen  # nothing is rendered anew
        np.testing.assert_array_equal(picture.pixels, tone_map(getattr(frame, layer), stops, CURVE))
    session.change(layer="image", exposure=1.0)
    np.testing.assert_array_equal(session.step().pixels, tone_map(frame.image, stops + 1, CURVE))


def test_surfaces_are_those_of_the_gbuffer(session, scene):
    gbuffer = trace_gbuffer(scene, size=SIZE)
    session.change(layer="albedo")
    np.testing.assert_array_equal(session.step().pixels, tone_map(gbuffer.albedo))
    session.change(layer="normals")
    shown = session.step().pixels / 255
    hit = np.isfinite(gbuffer.depth)
    np.testing.assert_allclose(2 * shown[hit] - 1, gbuffer.normal[hit], atol=1.001 / 255)  # half a step of 2 / 255, and rounding


MADE = [
    (VOXELS, "voxels"), (VOXELS, "lit voxels"), (CACHES, "caches"), (CACHES, "clusters"), (CACHES, "voxels"), (LIGHTS, "clusters"),
    (LIGHTS, "light maps"), (SURFELS, "surfels"), (SURFELS, "clusters"), (SURFELS, "caches"),
    (VOXELS.replace(shadow=ir.ShadowMap(size=16)), "shadow maps"),
    (LIGHTS.replace(shadow_lights=ir.ImperfectShadowMaps(size=8), filter_shadows=ir.SimpleLookup()), "shadow maps"),
]  # fmt: skip


@pytest.mark.parametrize(("method", "layer"), MADE)
def test_what_stages_make_is_drawn(shared, scene, method, layer):
    session = Session(shared, Wish(method, scene.camera, SIZE, layer=layer))
    pixels = session.step().pixels
    assert (pixels.shape, pixels.dtype) == ((SIZE[1], SIZE[0], 3), np.uint8)
    session.change(layer="image")
    assert np.unique(pixels.reshape(-1, 3), axis=0).shape[0] > 3
    assert (session.step().pixels != pixels).any()


@pytest.mark.parametrize(("method", "layer"), [(VOXELS, "caches"), (VOXELS, "surfels"), (VOXELS, "clusters"), (VOXELS, "shadow maps"),
                                               (LIGHTS, "voxels"), (VOXELS, "light maps")])  # fmt: skip
def test_what_a_method_does_not_make_is_an_error_that_names_it(shared, scene, method, layer):
    session = Session(shared, Wish(method, scene.camera, SIZE))
    kept = session.step()
    session.change(layer=layer)
    with pytest.raises(ValueError, match=f"{method.name} makes no "):
        session.step()
    assert not session.is_stale  # not tried again
    session.change(layer="image")
    assert session.step().pixels is not None and kept.seen is not None


def test_shadow_maps_hold_the_distance_to_what_the_light_meets():
    """A light 2 above a floor of half side 1: the centre of the map that looks down is 2 away, an open side infinitely far."""
    floor = ir.Mesh(np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], np.float32), np.array([[0, 2, 1], [0, 3, 2]], np.uint32))
    scene = ir.Scene(meshes=[floor], lights=[ir.PointLight(position=(0, 2, 0), intensity=(1, 1, 1))])
    depth = _core.shadow_maps(ir.ShadowMap(size=33), scene.core).depth
    assert [one.shape for one in depth] == [(33, 33)] * 6
    down = [one for one in depth if np.isfinite(one[16, 16])]
    assert len(down) == 1 and down[0][16, 16] == pytest.approx(2, rel=1e-6)
    assert np.isinf(down[0][0, 0])  # 45 degrees out, past the floor's edge


def test_sheets_lie_beside_each_other_and_open_texels_are_black():
    near, far = np.full((4, 4), 1, np.float32), np.full((4, 4), 2, np.float32)
    near[0, 0], near[1, 1], far[:] = 10, 5.5, np.inf
    sheet = sheets.depth_sheet([near, far], (8, 4))
    assert sheet.shape == (4, 8, 3)
    assert (sheet[:, 4:] == 0).all()
    assert [sheet[place] for place in ((0, 0, 0), (1, 1, 0), (3, 3, 0))] == [round(255 * 0.1), round(255 * 0.55), 255]


def test_dots_stand_where_points_project_unless_something_hides_them():
    camera = ir.Camera(position=(0, 0, 0), target=(0, 0, -1), fov_x=90)
    depth = np.full((50, 100), 10, np.float32)
    position = np.array([[0.01, -0.01, -5], [-2.45, -0.01, -5], [4.9, 0, -20], [1, 0, 5]], np.float32)
    picture = points.dots(np.zeros((50, 100, 3), np.uint8), position, depth, camera)
    assert sorted(map(tuple, np.argwhere(picture.any(-1)))) == [(25, 25), (25, 50)]  # half of tan 45 to the left, and the centre


def test_clusters_of_surfels_hold_each_once_and_none_too_many(shared, scene):
    tree = shared.prepared(SURFELS).state["surfels"]
    number = points.cut(tree, 16)
    count = np.bincount(number)
    assert count.sum() == len(tree.surfels) and count.min() > 0 and count.max() <= 16


def test_a_setting_that_cannot_be_rendered_leaves_the_last_picture(session, monkeypatch):
    session.step()
    session.change(method=VOXELS.replace({"grid.region": ir.Box(lower_x=1.0, upper_x=1.0)}))
    with pytest.raises(ValueError):
        session.step()
    assert not session.is_stale and not session.may_refine
    session.change(method=VOXELS)
    session.step()


def test_frames_follow_each_other_on_their_history_only_when_they_play(shared, scene):
    gathering = VOXELS.replace(light_voxels=ir.Bounces())  # a bounce more with every frame
    session = Session(shared, Wish(gathering, scene.camera, SIZE))
    first = session.step().seen
    assert not session.is_stale
    session.change(plays=True)
    assert session.is_stale
    second = session.step().seen
    assert session.is_stale and second is not first
    known = shared.prepared(gathering).render(scene.camera, size=SIZE, seed=1, history=first.frame.history)
    alone = shared.prepared(gathering).render(scene.camera, size=SIZE, seed=1)
    np.testing.assert_array_equal(second.frame.indirect, known.indirect)
    assert known.indirect.mean() > 1.01 * alone.indirect.mean()


def test_the_truth_refines_to_that_of_the_reference(scene):
    truth = RefiningTruth(scene, scene.camera, SIZE, bounces=1)
    noises = []
    while sum(half.spp for half in truth.halves) < 512:
        noises.append(truth.refine().noise)
    assert noises[-1] < noises[0] / 8  # 2 paths a pixel at first; a hundredth would be expected
    known = ir.methods.PathTracing(spp=512, bounces=1).render(scene, size=SIZE, seed=7)
    assert metrics.relmse(truth.latest.image, known.image) < 4 * noises[-1]  # twice the variance, and as much again for chance
    assert truth.latest.spp == sum(half.spp for half in truth.halves)


def test_a_truth_of_one_pass_is_the_mean_of_two_path_tracings(scene):
    truth = RefiningTruth(scene, scene.camera, SIZE, bounces=None).refine()
    frames = [ir.methods.PathTracing(spp=1, bounces=None).render(scene, size=SIZE, seed=stream_seed(0, half, 0)) for half in (0, 1)]
    np.testing.assert_allclose(truth.image, (frames[0].image + frames[1].image) / 2, rtol=1e-5, atol=1e-7)


def test_errors_are_those_of_the_metrics_and_flip_follows_in_a_turn_of_its_own(session):
    session.change(refines=True)
    assert session.step().errors is None and session.may_refine
    traced = session.refine()
    assert traced.errors.spp == 2 and traced.errors.flip is None
    measured = session.refine()
    frame, truth = measured.seen.frame, session._truth.latest
    assert measured.errors.spp == 2
    assert measured.errors.relmse == pytest.approx(metrics.relmse(frame.image, truth.image))
    assert measured.errors.flip.value == pytest.approx(metrics.flip(frame.image, truth.image))
    session.change(layer="indirect")
    other = session.step().errors
    assert other.relmse == pytest.approx(metrics.relmse(frame.indirect, truth.indirect))
    assert other.flip is None  # that of the image is not that of the indirect light
    assert session.refine().errors.flip.value == pytest.approx(metrics.flip(frame.indirect, truth.indirect))


def test_comparisons_show_truth_errors_and_both(session):
    method = session.step().pixels
    session.change(refines=True, comparison="truth")
    session.step()
    truth = session.refine().pixels
    session.change(comparison="half and half")
    both = session.step().pixels
    middle = SIZE[0] // 2
    np.testing.assert_array_equal(both[:, :middle], truth[:, :middle])
    np.testing.assert_array_equal(both[:, middle + 1 :], method[:, middle + 1 :])
    session.change(comparison="error map")
    errors = session.step()
    worst, best = np.unravel_index(np.argmax(errors.errors.map), (24, 32)), np.unravel_index(np.argmin(errors.errors.map), (24, 32))
    assert errors.pixels[worst].sum() > errors.pixels[best].sum()
    session.change(comparison="method")
    np.testing.assert_array_equal(session.step().pixels, method)


def test_another_view_begins_another_truth(session, scene):
    session.change(refines=True)
    session.step()
    session.refine()
    moved = ir.Camera(position=(0.1, 1, 3.9), target=(0, 1, 0), fov_x=39)
    session.change(camera=moved)
    assert session.step().errors is None
    session.change(truth_bounces="all")
    session.step()
    session.refine()
    assert session._truth.bounces is None and session._truth.camera == moved


@pytest.mark.parametrize("name", ["upright", "tilted", "down"])
def test_cameras_go_to_the_page_and_back(scene, name):
    camera = {
        "upright": ir.Camera(position=(0.3, 1, 3), target=(0, 0.5, 0), fov_x=50, size=(200, 100)),
        "tilted": ir.Camera(position=(0.3, 1, 3), target=(0, 0.5, 0), up=(0.5, 1, 0), fov_x=50, size=(200, 100)),
        "down": ir.Camera(position=(0, 1.9, 0), target=(0, 0, 0), up=(0, 0, -1), fov_x=50, size=(200, 100)),
    }[name]
    viser = pytest.importorskip("viser.transforms", reason="needs the extra `view`")
    space = Space.of(scene)
    pose = space.pose(camera, aspect=2.0)
    ahead = (pose.look_at - pose.position) / np.linalg.norm(pose.look_at - pose.position)
    right = np.cross(ahead, pose.up)
    right /= np.linalg.norm(right)
    turn = np.stack((right, np.cross(ahead, right), ahead), 1)  # x right, y down, z ahead
    found = space.camera(pose.position, pose.look_at, viser.SO3.from_matrix(turn).wxyz, pose.fov, 2.0, (200, 100))
    assert found.position == pytest.approx(camera.position, abs=1e-6)
    assert found.target == pytest.approx(camera.target, abs=1e-6)
    assert found.fov_x == pytest.approx(50)
    pixels = [trace_gbuffer(scene, one, (20, 10)).depth for one in (camera, found)]
    np.testing.assert_allclose(*pixels, rtol=1e-4)


def test_a_page_of_another_shape_shows_all_that_the_camera_does(scene):
    camera = ir.Camera(position=(0, 1, 3), target=(0, 1, 0), fov_x=40, size=(100, 100))
    for aspect, width in ((2.0, 2.0), (0.5, 1.0)):
        fov = Space.of(scene).pose(camera, aspect).fov
        assert np.tan(fov / 2) * aspect == pytest.approx(width * np.tan(np.radians(20)))


def test_clients_take_turns_and_one_that_fails_stops_nobody(shared, scene):
    shown, words = {1: [], 2: []}, []
    renderer = Renderer()
    sessions = {number: Session(shared, Wish(VOXELS, scene.camera, SIZE)) for number in shown}
    seen = threading.Event()
    try:
        for number, session in sessions.items():
            renderer.add(number, Client(session, shown[number].append, lambda text: (words.append(text), seen.set()), lambda: None))
        wait_for(lambda: all(shown.values()))
        sessions[1].change(layer="caches")
        renderer.wake()
        assert seen.wait(30) and "makes no caches" in words[0]
        sessions[2].change(exposure=1.0)
        renderer.wake()
        wait_for(lambda: len(shown[2]) == 2)
        renderer.remove(1)
        sessions[1].change(layer="image", exposure=2.0)
        sessions[2].change(exposure=3.0)
        renderer.wake()
        wait_for(lambda: len(shown[2]) == 3)
        assert len(shown[1]) == 1
    finally:
        renderer.stop()


def test_two_that_play_get_as_many_pictures(shared, scene):
    shown = {1: [], 2: []}
    renderer = Renderer()
    try:
        for number, pictures in shown.items():
            session = Session(shared, Wish(VOXELS, scene.camera, SIZE, plays=True))
            renderer.add(number, Client(session, pictures.append, pytest.fail, lambda: None))
        wait_for(lambda: min(map(len, shown.values())) >= 3)
    finally:
        renderer.stop()


def test_the_methods_used_last_stay_ready(scene):
    shared = Shared(scene)
    methods = [VOXELS.replace({"grid.resolution": 4 + k}) for k in range(5)]
    ready = [shared.prepared(method) for method in methods]
    assert [shared.is_ready(method) for method in methods] == [False, False, True, True, True]
    assert shared.prepared(methods[2]) is ready[2]
    shared.prepared(methods[0])
    assert shared.is_ready(methods[2]) and not shared.is_ready(methods[3])


def wait_for(true):
    end = time.monotonic() + 30
    while not true():
        assert time.monotonic() < end
        time.sleep(0.01)


def test_an_end_does_not_wait_for_a_long_preparation(shared, scene, monkeypatch):
    monkeypatch.setattr("interreflect.live.renderer.MOST_SECONDS", 0.1)
    begun, go_on, shown = threading.Event(), threading.Event(), []
    session = Session(shared, Wish(VOXELS, scene.camera, SIZE))
    monkeypatch.setattr(session, "step", lambda: (begun.set(), go_on.wait(30)))
    renderer = Renderer()
    renderer.add(1, Client(session, shown.append, shown.append, lambda: None))
    assert begun.wait(30)
    start = time.monotonic()
    renderer.stop()
    assert time.monotonic() - start < 10
    go_on.set()
    renderer._thread.join(30)
    assert shown == [] and not renderer._thread.is_alive()
