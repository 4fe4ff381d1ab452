"""Clusters as a picture."""

import numpy as np
import pytest

import interreflect as ir

SIZE = (64, 48)


@pytest.fixture(scope="module")
def seen():
    scene = ir.scenes.cornell_box()
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    return gbuffer, ir.distribute(ir.Clustered(caches=0, tile=16), gbuffer, scene)


def test_pixels_have_one_colour_where_they_share_a_cluster_and_black_where_they_have_none(seen):
    gbuffer, places = seen
    picture = ir.cluster_view(places, dots=False)
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    without = ~np.isfinite(gbuffer.depth)
    assert without.any()
    assert (picture[without] == 0).all()
    for i in range(len(places)):
        colours = np.unique(picture[places.cluster == i], axis=0)
        assert len(colours) == 1
        assert colours.max() > 0


def test_neighbouring_clusters_differ_in_colour(seen):
    _, places = seen
    picture = ir.cluster_view(places, dots=False)
    border = (places.cluster[:, 1:] != places.cluster[:, :-1]) & (np.minimum(places.cluster[:, 1:], places.cluster[:, :-1]) < len(places))
    assert border.any()
    assert (np.abs(picture[:, 1:] - picture[:, :-1])[border].max(1) > 0.02).all()


def test_a_dot_stands_at_every_cache(seen):
    _, places = seen
    x, y = places.screen.astype(int).T
    assert (ir.cluster_view(places)[y, x] == np.float32((0.05, 1.0, 0.1))).all()


def test_a_background_of_another_size_is_refused(seen):
    with pytest.raises(ValueError, match="background must have the picture's shape"):
        ir.cluster_view(seen[1], background=np.zeros((3, 3, 3), np.float32))


def light_maps_and_lights(count=16):
    maps = ir.light_maps(ir.scenes.cornell_box(light="spot"), size=64)
    seeds = ir.sample_lights(ir.HaltonLights(lights=count), maps)
    return maps, seeds, ir.cluster_lights(ir.KMeans(splat_size=64), seeds, maps)


def test_texels_have_one_colour_where_they_share_a_light_and_black_where_they_send_nothing_on():
    maps, _, lights = light_maps_and_lights()
    picture = ir.light_cluster_view(lights, maps, dots=False)
    assert picture.shape == (64, 64, 3)
    dark = np.asarray(maps.maps[0].flux).max(-1) == 0
    assert dark.any() and (picture[dark] == 0).all()
    colours = [np.unique(picture[lights.cluster[0] == i], axis=0) for i in range(len(lights))]
    assert all(len(one) == 1 and one.max() > 0 for one in colours)
    assert len(np.unique(np.concatenate(colours), axis=0)) == len(lights)


def test_a_dot_stands_at_every_light_and_seeds_without_clusters_are_dots_alone():
    maps, seeds, lights = light_maps_and_lights()
    for some in (seeds, lights):
        green = (ir.light_cluster_view(some, maps) == np.float32((0.05, 1.0, 0.1))).all(-1)
        assert green[some.texel // 64, some.texel % 64].all()
    assert green.sum() == len(np.unique(lights.texel))
    assert set(np.unique(ir.light_cluster_view(seeds, maps))) == {np.float32(0), *map(np.float32, (0.05, 1.0, 0.1))}


def test_lights_of_another_map_are_not_drawn_and_a_map_that_is_not_there_is_refused():
    scene = ir.scenes.cornell_box(light="spot")
    maps = ir.light_maps(scene.replace(lights=[scene.lights[0], scene.lights[0]]), size=64)
    lights = ir.sample_lights(ir.HaltonLights(lights=16), maps)
    dots = [(ir.light_cluster_view(lights, maps, number) == np.float32((0.05, 1.0, 0.1))).all(-1) for number in (0, 1)]
    expected = [np.unique(lights.texel[lights.texel // 64**2 == number]) for number in (0, 1)]
    assert [dot.sum() for dot in dots] == [len(one) for one in expected] and all(len(one) for one in expected)
    with pytest.raises(ValueError, match="one of 2 maps"):
        ir.light_cluster_view(lights, maps, 2)
    with pytest.raises(ValueError, match="background must have"):
        ir.light_cluster_view(lights, maps, background=np.zeros((3, 3, 3), np.float32))
