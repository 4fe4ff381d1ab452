"""The table of closed forms against Monte Carlo in a few lines of numpy that know neither the renderer nor the formulas."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect.scenes as scenes

SAMPLES = 200_000
TABLE = [  # row, knobs, the table's number
    (1, {}, 2), (1, {"albedo": 0.8}, 5), (1, {"bounces": 0}, 1.5), (1, {"albedo": 0.8, "bounces": 0}, 1.8),
    (2, {}, 0.333333), (2, {"bounces": 0}, 0.25),
    (3, {}, 1), (3, {"part": "direct"}, 0.5), (3, {"part": "indirect"}, 0.25),
    (4, {}, 0.0397887), (4, {"bounces": None}, 0.0795775),
    (5, {}, 0.199825), (6, {}, 0.200044),
    (7, {}, 0.381966), (7, {"other_radius": 0.5, "distance": 2}, 0.048059),
    (8, {}, 0.5), (8, {"offset": 1}, 0.276393),
    (9, {}, 0.25), (10, {}, 0.03125), (11, {}, 0.853553), (12, {}, 0.239456),
    (13, {}, 0.2), (13, {"bounces": 0}, 0.125),
    (14, {}, 0.25), (15, {}, 2.094395),
    (16, {}, 1.0625), (16, {"angle": 90}, 0.09375), (16, {"angle": 180}, 0.0625),
    (17, {}, 0.306853), (17, {"alpha": 0.1}, 0.9884), (17, {"alpha": 0.25}, 0.9158), (17, {"alpha": 0.5}, 0.688),
]  # fmt: skip


@pytest.mark.parametrize(("row", "knobs", "value"), TABLE)
def test_formulas_give_the_numbers_of_the_table(row, knobs, value):
    last_digit = {0.9884: 1e-4, 0.9158: 1e-4, 0.688: 1e-3}.get(value, 1e-6)
    assert scenes.closed_form(row, **knobs).value == pytest.approx(value, abs=0.51 * last_digit)


def agrees(samples, row, **knobs):
    """Whether the samples' mean is the closed form within 4 standard errors."""
    value = scenes.closed_form(row, **knobs).value
    error = samples.std() / np.sqrt(samples.size)
    assert abs(samples.mean() - value) < 4 * error + 1e-12, (row, knobs, samples.mean(), value, error)


def cosine_directions(rng, normals):
    """One direction about each unit normal, density cos / pi: a point of the unit sphere around the normal's tip."""
    on_sphere = rng.normal(size=normals.shape)
    on_sphere /= np.linalg.norm(on_sphere, axis=-1, keepdims=True)
    w = normals + on_sphere
    return w / np.linalg.norm(w, axis=-1, keepdims=True)


def from_floor(rng, n=SAMPLES):
    return cosine_directions(rng, np.broadcast_to((0.0, 1.0, 0.0), (n, 3)))


def cube_walk(rng, emission, albedo, bounces, n=SAMPLES):
    """Radiosity at random points of the unit cube's faces. `emission`: of the six faces, -x, -y, -z, +x, +y, +z."""
    face = rng.integers(6, size=n)
    p = rng.uniform(size=(n, 3))
    p[np.arange(n), face % 3] = face // 3
    total, weight = np.zeros(n), 1.0
    for _ in range(2 if bounces == 0 else 60):  # .8^60 = 2e-6
        total += weight * np.asarray(emission)[face]
        weight *= albedo
        normals = np.zeros((n, 3))
        normals[np.arange(n), face % 3] = 1.0 - 2 * (face // 3)
        d = cosine_directions(rng, normals)
        t = np.where(d > 0, (1 - p) / d, -p / d)
        t[np.arange(n), face % 3] = np.where(face // 3 == 1, -1 / d.T[face % 3, np.arange(n)], 1 / d.T[face % 3, np.arange(n)])
        axis = t.argmin(1)
        p = p + t.min(1)[:, None] * d
        side = (d[np.arange(n), axis] > 0).astype(int)
        p[np.arange(n), axis] = side
        face = axis + 3 * side
    return total


@pytest.mark.parametrize("albedo", [0.5, 0.8])
@pytest.mark.parametrize("bounces", [None, 0])
def test_radiance_in_a_furnace_sums_every_reflection(albedo, bounces):
    samples = cube_walk(np.random.default_rng(1), [1] * 6, albedo, bounces, n=100)
    assert samples == pytest.approx(scenes.closed_form(1, albedo=albedo, bounces=bounces).value, rel=1e-5)


@pytest.mark.parametrize("bounces", [None, 0])
def test_mean_radiosity_of_a_cube_with_one_emitting_face(bounces):
    agrees(cube_walk(np.random.default_rng(2), [1, 0, 0, 0, 0, 0], 0.5, bounces), 2, bounces=bounces)


def across(p, d):
    """Where rays from points p of the unit sphere along unit directions d meet it again."""
    return p - 2 * np.sum(p * d, -1, keepdims=True) * d


def on_sphere(rng, n=SAMPLES):
    p = rng.normal(size=(n, 3))
    return p / np.linalg.norm(p, axis=1, keepdims=True)


def test_a_lit_sphere_is_lit_evenly_reflection_by_reflection():
    # Irradiance I / R^2 = pi everywhere, so each reflection is rho times the light before it.
    radiance = 0.5 * np.pi / np.pi
    assert scenes.closed_form(3, part="direct").value == pytest.approx(radiance)
    assert scenes.closed_form(3, part="indirect").value == pytest.approx(0.5 * radiance)
    assert scenes.closed_form(3).value == pytest.approx(sum(radiance * 0.5**k for k in range(50)))


@pytest.mark.parametrize("receiver", [(1, 0, 0), (-1, 0, 0), (0, 0.6, -0.8)])
@pytest.mark.parametrize("bounces", [1, None])
def test_a_spot_in_a_sphere_lights_every_place_alike(receiver, bounces):
    rng = np.random.default_rng(3)
    (spot,) = scenes.integrating_sphere().lights
    p = np.broadcast_to(np.array(receiver, float), (SAMPLES, 3))
    irradiance = np.zeros(SAMPLES)
    for reflection in range(1, 2 if bounces == 1 else 30):
        p = across(p, cosine_directions(rng, -p))
        to_light = np.array(spot.position) - p
        distance = np.linalg.norm(to_light, axis=1)
        inside = -to_light @ np.array(spot.direction) / distance > np.cos(np.radians(spot.outer))
        facing = np.sum(-p * to_light, 1) / distance
        irradiance += 0.5**reflection * np.where(inside, spot.intensity[0] * facing / distance**2, 0)
    agrees(irradiance, 4, bounces=bounces)


@pytest.mark.parametrize("bounces", [0, None])
def test_radiosity_of_a_sphere_around_a_glowing_one(bounces):
    rng = np.random.default_rng(4)
    p = on_sphere(rng)  # of the outer sphere, in its radii: the inner one has radius 1/2
    radiosity, weight = np.zeros(SAMPLES), np.ones(SAMPLES)
    for _ in range(1 if bounces == 0 else 40):
        d = cosine_directions(rng, -p)
        hits_inner = 1 - np.sum(p * d, 1) ** 2 < 0.25
        weight *= 0.5
        radiosity += np.where(hits_inner, weight, 0)
        weight = np.where(hits_inner, 0, weight)
        p = across(p, d)
    agrees(radiosity, 13, bounces=bounces)


def hits(p, d, height, inside):
    """Whether rays from points p of a floor meet the part of the plane at `height` where inside(x, z) holds."""
    q = p + d * ((height - p[:, 1:2]) / d[:, 1:2])
    return inside(q[:, 0], q[:, 2]).astype(float)


def unit_square(x, z):
    return np.maximum(np.abs(x), np.abs(z)) < 0.5


def points_of_square(rng):
    p = rng.uniform(-0.5, 0.5, size=(SAMPLES, 3))
    p[:, 1] = 0
    return p


def test_form_factor_of_parallel_squares():
    rng = np.random.default_rng(5)
    agrees(hits(points_of_square(rng), from_floor(rng), 1, unit_square), 5)


def test_form_factor_of_perpendicular_squares():
    rng = np.random.default_rng(6)
    p, d = points_of_square(rng), from_floor(rng)
    t = np.where(d[:, 0] < 0, (-0.5 - p[:, 0]) / d[:, 0], np.inf)
    wall = p + np.where(np.isfinite(t), t, 0)[:, None] * d
    agrees((np.isfinite(t) & (wall[:, 1] < 1) & (np.abs(wall[:, 2]) < 0.5)).astype(float), 6)


@pytest.mark.parametrize(("r1", "r2", "h"), [(1, 1, 1), (1, 0.5, 2)])
def test_form_factor_of_coaxial_disks(r1, r2, h):
    rng = np.random.default_rng(7)
    p = r1 * on_sphere(rng)
    p *= (np.sqrt(rng.uniform(size=SAMPLES)) / np.hypot(p[:, 0], p[:, 2]) * r1)[:, None]
    p[:, 1] = 0
    agrees(hits(p, from_floor(rng), h, lambda x, z: np.hypot(x, z) < r2), 7, radius=r1, other_radius=r2, distance=h)


@pytest.mark.parametrize("offset", [0, 1])
def test_form_factor_from_a_point_to_a_disk(offset):
    rng = np.random.default_rng(8)
    agrees(hits(np.zeros((1, 3)), from_floor(rng), 1, lambda x, z: np.hypot(x - offset, z) < 1), 8, offset=offset)


def towards_sphere(d, centre, radius):
    along = d @ np.array(centre)
    return ((along > 0) & (np.dot(centre, centre) - along**2 < radius**2)).astype(float)


def test_occlusion_by_a_sphere():
    agrees(towards_sphere(from_floor(np.random.default_rng(9)), (0, 1, 0), 0.5), 9)


def test_form_factor_from_a_point_to_a_tilted_sphere():
    centre = 2 * np.array([np.sin(np.pi / 3), np.cos(np.pi / 3), 0])
    agrees(towards_sphere(from_floor(np.random.default_rng(10)), centre, 0.5), 10)


def test_sky_beside_a_wall():
    d = from_floor(np.random.default_rng(11))
    agrees(1 - ((d[:, 0] < 0) & (d[:, 1] < -d[:, 0])).astype(float), 11)


def test_form_factor_from_a_point_to_a_square():
    agrees(hits(np.zeros((1, 3)), from_floor(np.random.default_rng(12)), 1, unit_square), 12)


def test_a_lambertian_floor_returns_the_albedo_of_what_it_gets():
    d = from_floor(np.random.default_rng(14))
    case = scenes.closed_form(14)
    leaving = np.pi * case.value * np.ones(len(d))  # radiance over projected directions
    assert leaving.mean() == pytest.approx(0.5 * np.pi * np.cos(np.pi / 3))


def test_irradiance_of_a_cosine_sky():
    agrees(np.pi * from_floor(np.random.default_rng(15))[:, 1], 15)


@pytest.mark.parametrize("angle", [0, 53.13, 90, 122.2, 180])
def test_three_bands_of_a_clamped_cosine(angle):
    # Zonal projection by quadrature, added up by the addition theorem.
    t, w = np.polynomial.legendre.leggauss(200)
    t, w = (t + 1) / 2, w / 2  # the other half is 0
    c = np.cos(np.radians(angle))
    legendre = [np.polynomial.legendre.Legendre.basis(band) for band in range(3)]
    bands = [(2 * k + 1) / (4 * np.pi) * 2 * np.pi * np.sum(w * t * p(t)) * p(c) for k, p in enumerate(legendre)]
    assert sum(bands) == pytest.approx(scenes.closed_form(16, angle=angle).value, rel=1e-9)


@pytest.mark.parametrize("alpha", [0.25, 0.5, 1])
def test_albedo_of_a_white_ggx_metal(alpha):
    cos_i = np.random.default_rng(17).uniform(1e-9, 1, size=SAMPLES)  # uniform on the hemisphere: density 1 / (2 pi)
    cos_h2 = (1 + cos_i) / 2
    d = alpha**2 / (np.pi * (cos_h2 * (alpha**2 - 1) + 1) ** 2)
    g = 2 * cos_i / (cos_i + np.sqrt(alpha**2 + (1 - alpha**2) * cos_i**2))
    agrees(2 * np.pi * d * g / 4, 17, alpha=alpha)


def test_measuring_reads_the_part_and_weighs_the_cameras():
    class Frame:
        def __init__(self, value):
            self.image = np.full((4, 4, 3), value, np.float32)
            self.direct = self.indirect = self.image / 2

    case = scenes.closed_form(2)
    assert case.measure(Frame(1), Frame(2), Frame(3)) == pytest.approx(np.pi * (1 + 2 + 4 * 3) / 6)
    assert scenes.closed_form(3, part="indirect").measure(Frame(1)) == pytest.approx(0.5)
    with pytest.raises(ValueError, match="one frame of each of"):
        case.measure(Frame(1))


def test_rows_and_knobs_that_do_not_exist_are_refused():
    with pytest.raises(ValueError, match=r"closed_form.row must be a whole number in \[1, 17\], got 18"):
        scenes.closed_form(18)
    with pytest.raises(TypeError, match=r"closed_form\(1\) has no knob 'albdo'; did you mean 'albedo'"):
        scenes.closed_form(1, albdo=0.5)
    with pytest.raises(ValueError, match="bounces must be None"):
        scenes.closed_form(1, bounces=3)
    with pytest.raises(ValueError, match="albedo"):
        scenes.closed_form(1, albedo=1.0)
