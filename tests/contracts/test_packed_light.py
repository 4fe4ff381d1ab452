"""Patches' light with one exponent for three colours: what it rounds, what it saves."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core, stages

SIZE = (48, 36)


@cache
def tree():
    return stages.cluster_surfels(ir.KdTree(), stages.place_surfels(ir.HaltonSurfels(surfels=2000), ir.scenes.cornell_box()))


@cache
def radiance(scale=1.0):
    """Of colours from equal to a hundred thousand times apart."""
    rng = np.random.default_rng(4)
    return np.float32(scale) * np.exp(rng.uniform(-11.5, 0, (len(tree()), 3))).astype(np.float32)


def pulled(packed, scale=1.0, radiosity=False):
    return stages.pull(tree(), radiance(scale), radiosity, packed)


@pytest.mark.parametrize("radiosity", [False, True])
def test_every_colour_is_rounded_by_at_most_a_512th_of_the_largest(radiosity):
    exact, packed = (np.asarray(pulled(way, radiosity=radiosity).value, np.float64) for way in (False, True))
    off = np.abs(packed - exact) / exact.max(1, keepdims=True)
    assert off.max() <= 2.0**-9
    assert off.max() > 2.0**-11  # it is rounded at all
    assert (packed - exact).mean() / exact.mean() == pytest.approx(0, abs=5e-4)  # to nearest, not down; dim colours beside bright ones to 0


@pytest.mark.parametrize("scale", [1e-12, 1e-3, 1e3, 1e12])
def test_the_range_follows_the_light(scale):
    exact, packed = (np.asarray(pulled(way, scale).value, np.float64) for way in (False, True))
    assert (np.abs(packed - exact).max(1) <= exact.max(1) / 2**9).all()


def test_powers_of_two_and_black_stay_as_they_are():
    light = np.zeros((len(tree()), 3), np.float32)
    assert not np.asarray(stages.pull(tree(), light, False, True).value).any()
    light[5] = (1, 0.5, 0)
    plain, packed = (np.asarray(stages.pull(tree(), light, True, way).value) for way in (False, True))
    leaf = int(np.asarray(tree().node)[5])
    assert packed[leaf] == pytest.approx(plain[leaf], rel=2**-9) and packed[leaf][1] == packed[leaf][0] / 2 and packed[leaf][2] == 0


def test_it_takes_a_third_of_the_memory():
    plain, packed = pulled(False), pulled(True)
    assert (plain.bytes, packed.bytes) == (12 * (2 * len(tree()) - 1), 4 * (2 * len(tree()) - 1))
    assert packed.packed and not plain.packed


@pytest.mark.parametrize("link", [ir.ShLinks(links=64), ir.RuntimeProjection(links=64), ir.AllSurfels(samples=100), ir.FluxLinks(links=32)])
@pytest.mark.parametrize("evaluate", [ir.SphericalHarmonicLobes(), ir.DirectLinks()])
def test_pictures_are_the_same_but_for_rounding(link, evaluate):
    method = ir.methods.IlluminanceComposition(
        place_surfels=ir.HaltonSurfels(surfels=1000), place_caches=ir.CacheGrid(nx=5, ny=5, nz=5), link=link, evaluate=evaluate
    )
    plain, packed = (
        np.asarray(method.replace(patch_light=way).render(ir.scenes.cornell_box(), size=SIZE).indirect)
        for way in ("floats", "shared exponent")
    )
    # Measured: 4e-4 and less on the mean. Links that are chosen by light may be others.
    assert 0 < np.abs(packed - plain).mean() / plain.mean() < (0.01 if isinstance(link, ir.FluxLinks) else 1e-3)


def test_an_unknown_way_to_keep_light_is_a_value_error():
    with pytest.raises(ValueError, match="patch_light must be one of floats, shared exponent"):
        ir.methods.IlluminanceComposition(patch_light="halves")
    assert _core.NodeLight.packed.__doc__
