"""How evenly surfels lie, against points whose spacing is known."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import kstest
from tests.stability.faults import overwrite

import interreflect as ir
from interreflect import stages
from interreflect.spacing import BLUE, HEXAGONAL, SurfelSpacing, by_chance


def placed(technique):
    return stages.place_surfels(technique, ir.scenes.cornell_box())


def on_a_plane(points):
    """Surfels of area 1 at these places, all on one side."""
    surfels = placed(ir.XorshiftSurfels(surfels=2 * len(points)))
    n = len(surfels)
    assert n >= len(points)
    # Those that are too many stand far away, in one place of their own.
    at = np.full((n, 3), -1e4, np.float32)
    at[: len(points), :2], at[: len(points), 2] = points, 0
    overwrite(surfels.position, at)
    overwrite(surfels.normal, np.broadcast_to(np.float32((0, 0, 1)), (n, 3)))
    overwrite(surfels.area, np.ones(n))
    spacing = ir.surfel_spacing(surfels)
    return SurfelSpacing(spacing.distance[n - len(points) :], 0)


def test_the_densest_packing_and_a_square_one_are_told():
    x, y = (np.ravel(v).astype(float) for v in np.mgrid[:20, :20])
    assert on_a_plane(np.stack([x, y], 1)).distance == pytest.approx(np.ones(400), rel=1e-5)
    hexagons = on_a_plane(HEXAGONAL * np.stack([x + 0.5 * (y % 2), np.sqrt(0.75) * y], 1))
    assert hexagons.distance == pytest.approx(np.full(400, HEXAGONAL), rel=1e-5)
    assert hexagons.too_near == 0 and hexagons.deviation < 1e-4


def test_points_at_random_have_the_distances_of_chance():
    """[Clark and Evans 1954]: distribution 1 - exp(-pi r^2), which `by_chance` is the density of."""
    points = np.random.default_rng(2).uniform(0, 60, (3600, 2))
    found = on_a_plane(points)
    inside = found.distance[found.distance < 1.4]
    # 1.36 / sqrt(3600) = .023 in nineteen of twenty trials, were distances independent; most points share theirs with their neighbour.
    assert kstest(inside, lambda r: (1 - np.exp(-np.pi * r**2)) / (1 - np.exp(-np.pi * 1.4**2))).statistic < 0.05
    assert found.mean == pytest.approx(0.5, rel=0.04) and found.deviation == pytest.approx(0.261, rel=0.06)
    assert found.too_near == pytest.approx(1 - np.exp(-np.pi * BLUE**2), abs=0.02)
    borders, density = found.histogram(bins=12)
    middle = (borders[1:] + borders[:-1]) / 2
    assert density == pytest.approx(by_chance(middle), abs=0.27)  # 4 standard errors of 700, most of which come in pairs
    assert (density * np.diff(borders)).sum() == pytest.approx((found.distance < borders[-1]).mean())


def test_relaxed_surfels_are_the_nearest_to_blue_noise_and_xorshift_to_chance():
    """J2. Measured .89, .69 and .25 too near; means .50, .63 and .89."""
    chance, halton, relaxed = (
        ir.surfel_spacing(placed(kind(surfels=4000))) for kind in (ir.XorshiftSurfels, ir.HaltonSurfels, ir.RelaxedSurfels)
    )
    assert chance.too_near == pytest.approx(1 - np.exp(-np.pi * BLUE**2), abs=0.04)
    assert relaxed.too_near < 0.6 * halton.too_near < 0.6 * chance.too_near
    assert relaxed.mean > halton.mean > chance.mean
    assert "nearer than blue noise" in repr(relaxed)


def test_the_chart_shows_the_histogram():
    found = ir.surfel_spacing(placed(ir.HaltonSurfels(surfels=500)))
    (axes,) = found.chart().axes
    assert axes.patches[0].get_data().values == pytest.approx(found.histogram()[1])


def test_surfels_without_neighbours_are_a_value_error():
    with pytest.raises(ValueError, match="has another one on its side"):
        ir.surfel_spacing(placed(ir.HaltonSurfels(surfels=1)))
