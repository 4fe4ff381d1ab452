"""Metrics on pictures whose distance is known in closed form."""

import colorsys
import math

import numpy as np
import pytest

from interreflect import metrics

random = np.random.default_rng(7)
NOISY = random.uniform(0.1, 2.0, (48, 64, 3))
EVERY = [
    metrics.relmse,
    metrics.trimmed_relmse,
    metrics.energy_ratio,
    metrics.hue_shift,
    metrics.ssim,
    metrics.flip,
    metrics.error_map,
]


def constant(value, shape=(32, 40)):
    return np.broadcast_to(np.asarray(value, np.float32), (*shape, 3)).copy()


def test_relmse_of_constants_is_the_squared_difference_over_the_square_plus_epsilon():
    # (3 - 2)^2 / (4 + .01 * 4)
    assert metrics.relmse(constant(3), constant(2)) == pytest.approx(1 / 4.04, rel=1e-12)


def test_relmse_of_unbiased_relative_noise_is_its_variance():
    truth = constant(1.0, (256, 256))
    noisy = truth + random.normal(0, 0.2, truth.shape)
    # variance .04 / 1.01; standard error of the mean of 196,608 squares is sqrt(2 / n) = .32 %; four of them
    assert metrics.relmse(noisy, truth) == pytest.approx(0.04 / 1.01, rel=0.013)


@pytest.mark.parametrize("metric", [metrics.relmse, metrics.trimmed_relmse, metrics.energy_ratio, metrics.hue_shift, metrics.ssim])
@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_exposure_does_not_matter(metric, scale):
    other = NOISY * random.uniform(0.8, 1.2, NOISY.shape)
    assert metric(other * scale, NOISY * scale) == pytest.approx(metric(other, NOISY), rel=1e-9)


@pytest.mark.parametrize("scale", [1e-4, 1e4])
def test_flip_follows_the_exposure_of_the_reference(scale):
    other = NOISY * random.uniform(0.8, 1.2, NOISY.shape)
    # FLIP computes in single precision
    assert metrics.flip(other * scale, NOISY * scale) == pytest.approx(metrics.flip(other, NOISY), rel=1e-4)


@pytest.mark.parametrize(
    ("metric", "perfect"),
    [
        (metrics.relmse, 0),
        (metrics.trimmed_relmse, 0),
        (metrics.energy_ratio, 1),
        (metrics.hue_shift, 0),
        (metrics.ssim, 1),
        (metrics.flip, 0),
    ],
)
def test_a_picture_is_no_distance_from_itself(metric, perfect):
    assert metric(NOISY, NOISY) == pytest.approx(perfect, abs=1e-6)  # FLIP and SSIM: rounding of single precision


def test_trimming_removes_exactly_the_largest_thousandth():
    truth = constant(1.0, (100, 100))  # 30,000 terms, 30 of them trimmed
    fireflies = truth.copy()
    fireflies.reshape(-1)[:30] = 100.0
    assert metrics.trimmed_relmse(fireflies, truth) == 0.0
    fireflies.reshape(-1)[30] = 100.0
    assert metrics.trimmed_relmse(fireflies, truth) == pytest.approx(99**2 / 1.01 / 29_970)
    assert metrics.relmse(fireflies, truth) == pytest.approx(31 * 99**2 / 1.01 / 30_000)


def test_energy_ratio_is_the_ratio_of_means():
    assert metrics.energy_ratio(NOISY * 0.75, NOISY) == pytest.approx(0.75)


@pytest.mark.parametrize("degrees", [0, 30, 120, 180, 270])
def test_turning_every_hue_shifts_it_by_that_angle(degrees):
    turned = np.array([colorsys.hls_to_rgb((h + degrees / 360) % 1, 0.5, 0.6) for h in np.linspace(0, 1, 25)])
    plain = np.array([colorsys.hls_to_rgb(h, 0.5, 0.6) for h in np.linspace(0, 1, 25)])
    shift = metrics.hue_shift(turned.reshape(5, 5, 3), plain.reshape(5, 5, 3))
    # the hexagonal hue of colorsys departs from the angle of the circle by at most 1.12 degrees in either picture
    assert shift == pytest.approx(min(degrees, 360 - degrees), abs=2.3)


def test_rotation_about_the_grey_axis_shifts_the_hue_exactly():
    angle, axis = math.radians(20), np.ones(3) / math.sqrt(3)
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    rotation = np.eye(3) + math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    coloured = constant((2.0, 1.0, 1.2))
    assert metrics.hue_shift((coloured @ rotation.T), coloured) == pytest.approx(20, abs=1e-4)  # float32 colours


def test_grey_has_no_hue():
    assert metrics.hue_shift(constant(1), constant((1, 0, 0))) == 0.0


def test_the_error_map_averages_to_relmse_and_points_at_the_error():
    wrong = constant(1)
    wrong[3, 5] = 2
    where = metrics.error_map(wrong, constant(1))
    assert where.shape == (32, 40)
    assert where.mean() == pytest.approx(metrics.relmse(wrong, constant(1)))
    assert np.argwhere(where > 0).tolist() == [[3, 5]]


def test_flip_of_white_against_black_is_close_to_its_maximum():
    white = metrics.flip(constant(1e4), constant(0), -2, 2)
    assert 0.9 < white <= 1.0  # the largest value of the map is 1


def test_a_black_reference_is_handled():
    black = constant(0)
    assert metrics.flip(black, black) == 0.0
    assert metrics.flip(constant(1), black) > 0.5
    assert metrics.relmse(black, black) == 0.0
    assert metrics.relmse(constant(1), black) == math.inf
    assert metrics.energy_ratio(black, black) == 1.0
    assert metrics.energy_ratio(constant(1), black) == math.inf
    assert metrics.ssim(black, black) == pytest.approx(1.0)


def test_ssim_falls_with_noise_and_is_symmetric_under_its_own_tone_map():
    little, much = (NOISY * np.exp(random.normal(0, s, NOISY.shape)) for s in (0.05, 0.5))
    assert 1.0 > metrics.ssim(little, NOISY) > metrics.ssim(much, NOISY)


def test_negative_light_is_measured_not_refused():
    negative = NOISY.copy()
    negative[0, 0] = -1.0
    assert all(math.isfinite(float(np.mean(metric(negative, NOISY)))) for metric in EVERY)


@pytest.mark.parametrize("metric", EVERY)
@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_value_errors(metric, bad):
    broken = NOISY.copy()
    broken[1, 2, 0] = bad
    with pytest.raises(ValueError, match="image has 1 numbers that are not finite"):
        metric(broken, NOISY)
    with pytest.raises(ValueError, match="reference has 1 numbers"):
        metric(NOISY, broken)


@pytest.mark.parametrize("metric", EVERY)
def test_different_shapes_are_value_errors(metric):
    with pytest.raises(ValueError, match="same shape"):
        metric(NOISY, NOISY[:-1])
    with pytest.raises(ValueError, match="shape"):
        metric(NOISY[..., 0], NOISY[..., 0])


def test_ssim_says_how_many_pixels_it_needs():
    with pytest.raises(ValueError, match="11 x 11"):
        metrics.ssim(NOISY[:8], NOISY[:8])


def test_exposures_out_of_order_are_value_errors():
    with pytest.raises(ValueError, match="exposures"):
        metrics.flip(NOISY, NOISY, 2, -2)
