"""Where caches stand: as many as are wanted, each for the pixels of its cluster, whatever the picture shows and the scene's unit is."""

from __future__ import annotations

import dataclasses
import functools

import numpy as np
import pytest
from voxel_scenes import floor

import interreflect as ir
from interreflect import _core, stages

NO_CACHE = 2**32 - 1
CLUSTERED = (ir.Clustered, ir.CubeFaceClustered)
SCENES = {
    "cornell": ir.scenes.cornell_box, "atrium": lambda: ir.scenes.atrium(20_000), "grille": ir.scenes.grille,
    "ball": ir.scenes.ball_on_floor, "foliage": ir.scenes.foliage,
}  # fmt: skip


@functools.cache
def seen(name, size=(320, 240)):
    scene = SCENES[name]()
    return scene, stages.trace_gbuffer(scene, next(iter(scene.cameras)), size)


def small(meshes, size, position=(0, 2, 2), target=(0, 0, 0)):
    scene = ir.Scene(meshes=meshes, cameras={"view": ir.Camera(position=position, target=target, fov_x=60)})
    return scene, stages.trace_gbuffer(scene, "view", size)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("technique", CLUSTERED)
def test_there_are_about_as_many_caches_as_are_wanted(technique, name):
    scene, gbuffer = seen(name)
    for wanted in (100, 1000):
        found = len(stages.distribute(technique(caches=wanted), gbuffer, scene))
        # The count is estimated from 128 tiles, and whole pixels are a coarse choice for small tiles.
        assert abs(np.log(found / wanted)) < np.log(1.35), (found, wanted)


@pytest.mark.parametrize("technique", [*CLUSTERED, ir.Equidistant])
def test_clusters_partition_the_pixels_that_see_a_surface(technique):
    for name in SCENES:
        scene, gbuffer = seen(name)
        places = stages.distribute(technique(caches=500), gbuffer, scene)
        hit = np.isfinite(gbuffer.depth)
        cluster = np.asarray(places.cluster)
        if technique is not ir.Equidistant:
            assert ((cluster != NO_CACHE) == hit).all()
            assert (cluster.ravel()[places.pixel] == np.arange(len(places))).all()
        assert (np.bincount(cluster[cluster != NO_CACHE], minlength=len(places)) == places.members).all()
        y, x = np.divmod(places.pixel, gbuffer.depth.shape[1])
        assert (np.asarray(gbuffer.position)[y, x] == places.position).all()
        assert (np.asarray(places.screen) == np.stack([x, y], 1) + 0.5).all()
        # Caches follow each other in the order of their tiles, and clusters keep to their tile.
        tile = (y // places.tile) * places.columns + x // places.tile
        assert (np.diff(tile.astype(int)) >= 0).all()
        rows, columns = np.nonzero(cluster != NO_CACHE)
        own = (rows // places.tile) * places.columns + columns // places.tile
        assert (tile[cluster[rows, columns]] == own).all()


@pytest.mark.parametrize("technique", CLUSTERED)
@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_clusters_and_their_pixels_do_not_depend_on_the_scenes_unit(technique, scale):
    scene, gbuffer = seen("atrium")
    camera = next(iter(scene.cameras.values()))
    to = np.diag([scale, scale, scale, 1.0])
    meshes = [mesh.replace(transform=to @ mesh.transform) for mesh in scene.meshes]
    moved = dataclasses.replace(
        camera, position=tuple(scale * np.asarray(camera.position)), target=tuple(scale * np.asarray(camera.target))
    )  # fmt: skip
    other = ir.Scene(meshes=meshes, cameras={"view": moved})
    again = stages.trace_gbuffer(other, "view", (320, 240))
    one, two = (stages.distribute(technique(caches=0, tile=24), g, s) for g, s in ((gbuffer, scene), (again, other)))
    # Depths at the border of two slices, and scores that tie, are decided by rounding.
    assert abs(len(one) - len(two)) <= 0.01 * len(one)
    assert len(np.intersect1d(one.pixel, two.pixel)) >= 0.9 * len(one)


def test_axes_of_the_tiles_normals_need_fewer_clusters_than_cube_faces_on_a_bent_surface():
    scene, gbuffer = seen("ball")
    for tile in (12, 24, 48):
        adapted, fixed = (len(stages.distribute(technique(caches=0, tile=tile), gbuffer, scene)) for technique in CLUSTERED)
        assert adapted < 0.95 * fixed, tile


def test_opposite_walls_in_one_tile_get_caches_of_their_own():
    wall = floor(half=0.5)
    left, right = (wall.replace(transform=t @ wall.transform) for t in (_upright(0.0, -0.3), _upright(180.0, 0.3)))
    scene, gbuffer = small([left, right], (64, 64), position=(0, 0, 1.5))
    places = stages.distribute(ir.Clustered(caches=0, tile=64, slice_depth=0.0), gbuffer, scene)
    normals = np.asarray(places.normal)
    assert (normals @ normals.T).min() < -0.9


def _upright(turn, x):
    """A floor stood up so that it faces along x, then turned about y."""
    a = np.radians(turn)
    about_y = np.array([[np.cos(a), 0, np.sin(a), 0], [0, 1, 0, 0], [-np.sin(a), 0, np.cos(a), 0], [0, 0, 0, 1]])
    stand = np.array([[0.0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    to = about_y @ stand
    to[0, 3] = x
    return to


def test_deeper_slices_make_fewer_clusters():
    scene, gbuffer = seen("atrium")
    counts = [len(stages.distribute(ir.Clustered(caches=0, tile=24, slice_depth=depth), gbuffer, scene)) for depth in (1, 4, 16, 0)]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1]


def test_equidistant_caches_leave_pixels_uncovered_that_clusters_cover():
    scene, gbuffer = seen("grille")
    way = ir.methods.ClusteredRadianceCaching(grid=ir.Grid(resolution=32), fill=ir.ConeFill(resolution=4))
    voxels = stages.voxelize(way.voxelize, scene, stages.place(way.grid, scene))
    pyramid = stages.prefilter(way.prefilter, stages.light_voxels(way.light_voxels, scene, voxels))
    missed = {}
    for technique in (ir.Equidistant, ir.Clustered):
        places = stages.distribute(technique(caches=300), gbuffer, scene)
        caches = stages.preconvolve(way.preconvolve, stages.fill(way.fill, places, pyramid, scene))
        missed[technique] = stages.interpolate(ir.Gather(), caches, gbuffer, scene, pyramid).counts.asdict().get("uncovered_pixels", 0)
    assert missed[ir.Equidistant] > 0
    assert missed[ir.Clustered] < 0.25 * missed[ir.Equidistant]


@pytest.mark.parametrize("technique", [*CLUSTERED, ir.Equidistant])
def test_odd_pictures_have_caches_where_there_is_a_surface(technique):
    everywhere = [floor(half=1e3)]
    scene, gbuffer = small(everywhere, (1, 1), position=(0, 1, 0.1))
    assert len(stages.distribute(technique(), gbuffer, scene)) == 1
    scene, gbuffer = small(everywhere, (30, 20), position=(0, 1, 0.1))
    assert len(stages.distribute(technique(caches=0, tile=4096), gbuffer, scene)) >= 1
    most = stages.distribute(technique(caches=1 << 22), gbuffer, scene)
    assert (most.tile, len(most)) == (1, 600)
    scene, gbuffer = small([floor(half=0.1)], (30, 20), position=(0, 1, 9), target=(0, 1, 10))
    sky = stages.distribute(technique(), gbuffer, scene)
    assert len(sky) == 0
    assert (np.asarray(sky.cluster) == NO_CACHE).all()
    triangle = ir.Mesh(np.float32([[-1, 0, 0], [1, 0, 0], [0, 0, -1]]), np.uint32([[0, 1, 2]]))
    scene, gbuffer = small([triangle], (30, 20))
    assert 1 <= len(stages.distribute(technique(caches=10), gbuffer, scene)) <= 30


@pytest.mark.parametrize("technique", [*CLUSTERED, ir.Equidistant])
def test_threads_do_not_change_where_caches_stand(technique):
    scene, gbuffer = seen("atrium")
    made = []
    for threads in (1, 2, 5):
        with _core.Threads(threads):
            made.append(stages.distribute(technique(caches=700), gbuffer, scene))
    for other in made[1:]:
        assert (other.pixel == made[0].pixel).all()
        assert (np.asarray(other.cluster) == made[0].cluster).all()
