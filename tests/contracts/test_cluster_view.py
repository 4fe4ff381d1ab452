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
