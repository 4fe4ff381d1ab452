"""Caches that stay from frame to frame: where they are kept, where they are dropped, and that they ride on their bodies."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import box, floor, quad, scene_of

import interreflect as ir
from interreflect import _core

SIZE = (96, 64)
CAMERA = ir.Camera(position=(0.4, 2.6, 3.4), target=(0, 0.3, 0), fov_x=55)
SUN = ir.DirectionalLight(direction=(0.3, -1, 0.2), irradiance=(3, 2, 1))
HELD = [ir.Clustered(caches=150), ir.CubeFaceClustered(caches=150), ir.Equidistant(caches=100)]
ARRAYS = ("position", "normal", "screen", "footprint", "pixel", "members", "body", "cluster")


def at(x=0.0, y=0.0, z=0.0, turn=0.0):
    """A pose: turned about y by `turn` degrees, then moved."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return np.array([[c, 0, s, x], [0, 1, 0, y], [-s, 0, c, z], [0, 0, 0, 1]], float)


def room(pose=None, *meshes, lights=(SUN,), camera=CAMERA):
    """A floor with a wall behind, and a cube that can move."""
    wall = quad([[-2, 0, -1.5], [2, 0, -1.5], [2, 2, -1.5], [-2, 2, -1.5]], albedo=(0.7, 0.2, 0.2))
    cube = box((-0.4,) * 3, (0.4,) * 3, body="cube", material=ir.Material(albedo=(0.2, 0.7, 0.3)))
    bodies = {"cube": at(0.0, 0.6, 0.3, 20) if pose is None else pose}
    return scene_of(floor(0, half=2), wall, cube, *meshes, lights=lights, cameras={"view": camera}, bodies=bodies)


def places_of(technique, scene, last=None, size=SIZE, camera=None):
    return ir.distribute(technique, ir.trace_gbuffer(scene, camera, size), scene, last)


def kept(places):
    return places.age > 0


def identical(a, b):
    return len(a) == len(b) and all(np.array_equal(getattr(a, name), getattr(b, name)) for name in ARRAYS)


@pytest.mark.parametrize("held", HELD, ids=lambda held: type(held).__name__)
def test_a_still_camera_keeps_every_cache_with_the_same_bits(held):
    technique, scene = ir.ReuseCaches(distribute=held), room()
    first = places_of(technique, scene)
    assert identical(first, places_of(held, scene)), "without history caches are placed as by the technique that is held"
    assert not first.age.any() and "reused_caches" not in first.counts.asdict()
    second = places_of(technique, scene, first)
    third = places_of(technique, scene, second)
    assert identical(first, second) and identical(second, third)
    assert (third.age == 2).all() and third.counts.asdict()["reused_caches"] == len(third) > 50


@pytest.mark.parametrize(("most", "spacing"), [(1, 0.0), (2, 0.0), (4, 0.5)])
@pytest.mark.parametrize("held", HELD, ids=lambda held: type(held).__name__)
def test_caches_stay_at_their_surface_points_while_the_camera_moves(held, most, spacing):
    technique = ir.ReuseCaches(distribute=held, most=most, spacing=spacing)
    last = places_of(technique, room())
    for step in range(1, 5):
        camera = ir.Camera(position=(0.4 + 0.03 * step, 2.6, 3.4), target=(0.03 * step, 0.3, 0), fov_x=55)
        scene = room(camera=camera)
        gbuffer = ir.trace_gbuffer(scene, size=SIZE)
        now = ir.distribute(technique, gbuffer, scene, last)
        stays = kept(now)
        assert stays.sum() == now.counts.asdict()["reused_caches"] > 0.5 * len(now)
        # What did not move keeps its bits.
        before = {p.tobytes() for p in last.position}
        assert all(p.tobytes() in before for p in now.position[stays])
        # Each is listed at the pixel that it is seen in, and in that pixel's tile.
        column, row = np.floor(now.screen).astype(int).T
        assert np.array_equal(now.pixel, row * SIZE[0] + column)
        tile = column // now.tile + row // now.tile * now.columns
        assert (np.diff(tile) >= 0).all()
        # It lies in the plane that is seen there, but for a tenth of a tile's width.
        seen, normal = (np.asarray(array)[row, column] for array in (gbuffer.position, gbuffer.normal))
        width = now.tile * 2 * np.tan(np.radians(27.5)) / SIZE[0] * np.linalg.norm(now.position - camera.position, axis=1)
        assert (np.abs(((seen - now.position) * now.normal).sum(1)) <= 0.1001 * width).all()
        assert ((normal * now.normal).sum(1) > np.cos(np.radians(30)) - 1e-5).all()
        # No cluster has more than its share, and none is left alone but where another's cache is near.
        served = np.unique(now.cluster[now.cluster != 2**32 - 1])
        assert len(served) <= now.counts.asdict()["clusters"] and len(served) <= len(now) <= most * len(served)
        assert spacing > 0 or len(served) == now.counts.asdict()["clusters"]
        last = now


def test_of_two_caches_in_one_cluster_the_older_one_stays_or_both_do():
    """The camera draws back until the picture's clusters are fewer than the caches that it still shows."""
    counts = {}
    for most in (1, 4):
        technique = ir.ReuseCaches(distribute=ir.Clustered(caches=0, tile=8), most=most, spacing=0.0)
        places = None
        for back in (1.0, 1.02, 1.6):
            camera = ir.Camera(position=(0.4 * back, 2.6 * back, 3.4 * back), target=(0, 0.3, 0), fov_x=55)
            before, places = places, places_of(technique, room(camera=camera), places)
        old = {p.tobytes() for p, age in zip(before.position, before.age, strict=True) if age == 1}
        young = {p.tobytes() for p, age in zip(before.position, before.age, strict=True) if age == 0}
        stays = [p.tobytes() for p in places.position[kept(places)]]
        counts[most] = (len(stays), sum(p in old for p in stays) / len(old), sum(p in young for p in stays) / len(young))
    assert counts[4][0] > 1.3 * counts[1][0], "with room for four more of them stay"
    assert counts[1][1] > 1.5 * counts[1][2], "where one must go, those kept before outlast the new ones"


def test_a_cluster_gets_no_cache_of_its_own_where_one_that_stays_is_near():
    """The camera pans until surfaces have passed below several tiles."""
    played, apart = {}, []
    for spacing in (0.0, 0.5):
        technique, last = ir.ReuseCaches(distribute=ir.Clustered(caches=0, tile=8), spacing=spacing), None
        for step in range(12):
            last = places_of(technique, room(camera=ir.Camera(position=CAMERA.position, target=(0.03 * step, 0.3, 0), fov_x=55)), last)
            if spacing == 0 or step == 0:
                continue
            new, old = ~kept(last), kept(last)
            away = np.linalg.norm(last.position[new][:, None] - last.position[old][None], axis=2) / last.footprint[old]
            alike = (last.normal[new] @ last.normal[old].T > np.cos(np.radians(30)) + 1e-5) & (last.body[new][:, None] == last.body[old])
            apart += list(away[alike])
        played[spacing] = last
    clusters = played[0.5].counts.asdict()["clusters"]
    assert clusters == played[0.0].counts.asdict()["clusters"], "clusters are this frame's"
    assert len(played[0.5]) < clusters < len(played[0.0])
    # New ones stand apart from those that stayed on their side: by half of what a tile is long where those are.
    assert len(apart) > 10 and min(apart) > 0.5


@pytest.mark.parametrize("board", [
    quad([[-0.9, 0.2, 1.2], [0.9, 0.2, 1.2], [0.9, 0.9, 1.2], [-0.9, 0.9, 1.2]]),
    floor(0.25, half=1.9),  # hides the floor, whose normal is the same
], ids=("upright", "level"))  # fmt: skip
def test_a_cache_that_an_occluder_hides_is_dropped_and_its_cluster_gets_another(board):
    technique = ir.ReuseCaches(distribute=ir.Clustered(caches=150))
    before = places_of(technique, room())
    hidden = np.asarray(ir.trace_gbuffer(room(None, board), size=SIZE).depth) < np.asarray(ir.trace_gbuffer(room(), size=SIZE).depth) - 0.05
    # The board belongs to the scene: what it hides is another scene's pixels, the caches are the first one's.
    after = places_of(technique, room(None, board), before)
    row, column = before.pixel // SIZE[0], before.pixel % SIZE[0]
    gone = {p.tobytes() for p in before.position[hidden[row, column]]}
    still = {p.tobytes() for p in before.position[~hidden[row, column]]}
    assert len(gone) > 10
    found = {p.tobytes() for p in after.position[kept(after)]}
    assert not found & gone and len(found & still) > 0.8 * len(still)


@pytest.mark.parametrize("pose", [at(0.05, 0.6, 0.3, 20), at(0.0, 0.6, 0.3, 27), at(0.03, 0.63, 0.28, 14)])
def test_caches_ride_on_a_body_that_moves_and_the_world_s_stand_still(pose):
    technique = ir.ReuseCaches(distribute=ir.Clustered(caches=400))
    before = places_of(technique, room())
    after = places_of(technique, room(pose), before)
    way = pose @ np.linalg.inv(at(0.0, 0.6, 0.3, 20))
    riding = kept(after) & (after.body == 1)
    of_body = before.body == 1
    assert riding.sum() > 0.5 * of_body.sum() > 10
    should_p = before.position[of_body] @ way[:3, :3].T + way[:3, 3]
    should_n = before.normal[of_body] @ way[:3, :3].T
    for p, n in zip(after.position[riding], after.normal[riding], strict=True):
        nearest = np.argmin(np.linalg.norm(should_p - p, axis=1))
        # Single precision about lengths of 1.
        assert np.allclose(p, should_p[nearest], atol=1e-6) and np.allclose(n, should_n[nearest], atol=1e-6)
    world = {p.tobytes() for p in before.position[~of_body]}
    assert all(p.tobytes() in world for p in after.position[kept(after) & (after.body == 0)])


def test_a_cut_to_another_view_drops_all_and_places_as_without_history():
    technique = ir.ReuseCaches(distribute=ir.Clustered(caches=0, tile=8))
    away = room(camera=ir.Camera(position=(0.4, 2.6, 3.4), target=(0.8, 4.9, 6.8), fov_x=55))
    ceiling = quad([[-9, 6, 9], [-9, 6, 2], [9, 6, 2], [9, 6, 9]])
    view = ir.Camera(position=(0.4, 2.6, 3.4), target=(0.5, 6.0, 5.0), fov_x=55)
    scene = room(None, ceiling)
    before = places_of(technique, scene)
    after = places_of(technique, scene, before, camera=view)
    assert len(after) > 50 and not kept(after).any() and identical(after, places_of(technique, scene, camera=view))
    assert len(places_of(technique, away, before)) == 0, "a view of nothing has no caches"


def test_lights_do_not_matter_for_places():
    technique, scene = ir.ReuseCaches(distribute=ir.Clustered(caches=150)), room()
    before = places_of(technique, scene)
    assert identical(places_of(technique, room(lights=()), before), before)


def test_the_picture_may_change_its_size_and_caches_stay():
    technique = ir.ReuseCaches(distribute=ir.Clustered(caches=150), most=16)
    before = places_of(technique, room())
    after = places_of(technique, room(), before, size=(120, 80))
    # All but those at edges, whose pixel sees something else now.
    assert kept(after).sum() > 0.95 * len(before) and after.cluster.shape == (80, 120)


def test_tiles_keep_their_size_while_their_clusters_are_about_as_many_as_are_wanted():
    held, wanted = ir.Clustered(caches=50), 50
    sizes = {}
    for tolerance in (0.0, 0.25):
        last, sizes[tolerance] = None, []
        for step in range(12):
            camera = ir.Camera(position=(0.4, 2.6 - 0.04 * step, 3.4 - 0.05 * step), target=(0, 0.3, 0), fov_x=55)
            last = places_of(ir.ReuseCaches(distribute=held, tolerance=tolerance), room(camera=camera), last)
            sizes[tolerance].append(last.tile)
            searched = places_of(held, room(camera=camera))
            # Two sizes may make as many clusters.
            assert tolerance > 0 or last.tile == searched.tile or last.counts.asdict()["clusters"] == wanted
            assert last.counts.asdict()["clusters"] <= max(wanted * (1 + tolerance), searched.counts.asdict()["clusters"])
    jumps = {tolerance: np.count_nonzero(np.diff(tiles)) for tolerance, tiles in sizes.items()}
    assert jumps[0.25] < jumps[0.0], sizes


def test_one_and_two_threads_give_the_same_bits():
    technique = ir.ReuseCaches(distribute=ir.Clustered(caches=400), most=2)
    found = []
    for threads in (1, 2):
        with _core.Threads(threads):
            last = places_of(technique, room())
            found.append(places_of(technique, room(at(0.05, 0.6, 0.3, 20)), last))
    assert identical(*found) and np.array_equal(found[0].age, found[1].age)


def test_another_technique_s_places_are_no_history():
    with pytest.raises(ValueError, match="ReuseCaches: the history is not of ReuseCaches"):
        places_of(ir.ReuseCaches(), room(), places_of(ir.Clustered(), room()))


def test_a_played_motion_hands_its_caches_on():
    method = ir.methods.ClusteredRadianceCaching(
        grid=ir.Grid(resolution=24), distribute=ir.ReuseCaches(distribute=ir.Clustered(caches=100))
    )
    frames = list(method.prepare(room()).play(ir.Motion.rotation(by=0.3, frames=3), size=SIZE))
    reused = [frame.profile.stages["distribute"].counts.get("reused_caches", 0) for frame in frames]
    assert reused[0] == 0 and min(reused[1:]) > 50
    still = list(method.prepare(room()).play(ir.Motion.still(frames=2), size=SIZE, seed=5))
    # TracedLighting of a sun and fills by cones know no chance, so the seed of a frame changes nothing.
    assert np.array_equal(still[0].image, still[1].image)
    assert ir.exact(method.distribute) == ir.CachePerPixel()


@pytest.mark.parametrize("knobs", [{}, {"radius": 5.0, "world_radius": 3.0}, {"radius": 0.5}, {"radius": 0.0}, {"world_radius": 1000.0}])
@pytest.mark.parametrize("factor", [1e-3, 1.0, 1e3])
def test_caches_found_through_a_hierarchy_light_pixels_as_those_found_by_tiles(knobs, factor):
    """Whatever the weights reject was found for nothing, and what they take is added in the same order: the same bits."""
    scene = scene_of(
        *(mesh.replace(transform=np.diag([factor] * 3 + [1.0]) @ mesh.transform) for mesh in room(at()).meshes if mesh.body == "world"),
        lights=[SUN],
        cameras={"view": ir.Camera(position=tuple(factor * np.array(CAMERA.position)), target=(0, 0.3 * factor, 0), fov_x=55)},
    )
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, ir.Grid(resolution=24).place(scene))
    pyramid = ir.prefilter(ir.OctantCoverage(), ir.light_voxels(ir.TracedLighting(both_sides=True), scene, voxels))
    caches = ir.preconvolve(ir.MipChain(), ir.fill(ir.ConeFill(resolution=4), places_of(ir.Clustered(caches=200), scene), pyramid, scene))
    lights = [ir.interpolate(ir.Gather(search=search, **knobs), caches, gbuffer, scene, pyramid) for search in ("tiles", "hierarchy")]
    assert np.array_equal(lights[0].weight, lights[1].weight)
    assert np.array_equal(lights[0].gathered.irradiance, lights[1].gathered.irradiance)
    assert lights[0].counts.asdict() == lights[1].counts.asdict()
    assert (lights[0].counts.asdict().get("cache_evaluations", 0) > 20000) == (knobs.get("radius") not in (0.0, 0.5))


def test_many_suns_bodies_apart_and_all_bounces_run_with_reused_caches_and_come_near_the_truth():
    """Ten suns: the paper's lights. Bounces wants one hierarchy, so bodies are apart in the other one."""
    random = np.random.default_rng(3)
    suns = [
        ir.DirectionalLight(direction=(*random.uniform(-0.6, 0.6, 1), -1.0, *random.uniform(-0.6, 0.6, 1)), irradiance=tuple(rgb))
        for rgb in random.uniform(0.1, 0.5, (10, 3))
    ]
    scene = room(lights=suns)
    places = ir.ReuseCaches(distribute=ir.Clustered(caches=200))
    shared = {"grid": ir.Grid(resolution=48), "distribute": places, "fill": ir.TracedFill()}
    lit = ir.TracedLighting(both_sides=True)
    once = ir.methods.ClusteredRadianceCaching(**shared, light_voxels=lit, bodies="apart")
    always = ir.methods.ClusteredRadianceCaching(**shared, light_voxels=ir.Bounces(light_voxels=lit))
    assert once.bounces == 1 and always.bounces is None
    means = {}
    for method in (once, always):
        frames = list(method.prepare(scene).play(ir.Motion.still(frames=6), size=SIZE))
        truth = ir.reference(scene, size=SIZE, bounces=method.bounces, noise=1e-2, max_spp=256)
        means[method.bounces] = frames[-1].indirect.mean()
        assert frames[-1].profile.stages["distribute"].counts["reused_caches"] > 100
        # Roughly: what rays of the fill meet has the light of voxels, to which cones bring that of further bounces, a sixth too much of it.
        assert means[method.bounces] == pytest.approx(truth.indirect.mean(), rel=0.15)
    assert means[None] > 1.1 * means[1], "further bounces add light"
