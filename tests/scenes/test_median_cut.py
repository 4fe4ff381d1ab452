"""An environment as suns: as bright as it was, on every side, and the same every time."""

import itertools

import numpy as np
import pytest

import interreflect as ir
from interreflect.metrics import LUMINANCE

UP = np.array([0.0, 1.0, 0.0])
COUNTS = (2, 4, 10, 37, 200)


def courtyard(rows: int = 64, seed: int = 3) -> ir.EnvironmentLight:
    """Blue sky, a reddish ground, walls, some bright windows; coloured and uneven as a photograph is."""
    rng = np.random.default_rng(seed)
    height = np.linspace(1, -1, rows)[:, None, None]
    image = np.where(height > 0, (0.4, 0.6, 1.0), (0.5, 0.35, 0.2)) * rng.uniform(0.5, 1.5, (rows, 2 * rows, 1))
    for _ in range(12):
        y, x = rng.integers(0, rows - 4), rng.integers(0, 2 * rows - 4)
        image[y : y + 3, x : x + 3] = rng.uniform(5, 60) * rng.uniform(0.3, 1, 3)
    return ir.EnvironmentLight(image=image.astype(np.float32), radiance=(2.0, 1.5, 1.0))


def sampled(environment, hemisphere=True):
    """Directions and radiance times solid angle of 4 x 4 points a texel (nearest texel, image's own frame)."""
    image = environment.image
    h, w, n = len(image), image.shape[1], 4
    theta = (np.arange(n * h) + 0.5) * np.pi / (n * h)
    phi = (np.arange(n * w) + 0.5) * 2 * np.pi / (n * w) - np.pi
    sine = np.sin(theta)[:, None]
    towards = np.stack([sine * np.sin(phi), np.cos(theta)[:, None] + 0 * phi, -sine * np.cos(phi)], 2)
    flux = np.repeat(np.repeat(image, n, 0), n, 1) * environment.radiance * (sine * np.pi / (n * h) * 2 * np.pi / (n * w))[..., None]
    return towards, flux * (theta < np.pi / 2)[:, None, None] if hemisphere else flux


def irradiance(lights, normal):
    return sum(max(0.0, -float(np.dot(light.direction, normal))) * np.array(light.irradiance) for light in lights)


def irradiance_of(environment, normal, hemisphere=True):
    towards, flux = sampled(environment, hemisphere)
    return np.einsum("ij,ijc->c", np.maximum(towards @ np.asarray(normal, float), 0), flux)


@pytest.mark.parametrize("count", COUNTS)
def test_the_ground_is_as_bright_under_the_suns_as_under_the_environment(count):
    environment = courtyard()
    lights, truth = ir.directional_lights(environment, count), irradiance_of(environment, UP)
    assert len(lights) == count and all(light.direction[1] < 0 for light in lights)
    # Regions of one cut may reach 90 degrees from their light; a texel is .05 wide where it is sampled 4 x 4.
    assert irradiance(lights, UP) @ LUMINANCE == pytest.approx(truth @ LUMINANCE, rel=1e-3 if count > 2 else 0.02)
    # A light has the mean colour of a region and the mean direction of its luminance: a tenth at 4, falling with the regions' size.
    assert irradiance(lights, UP) == pytest.approx(truth, rel=0.4 / count)


@pytest.mark.parametrize("normal", [(0.6, 0.8, 0), (-0.6, 0.48, 0.64), (0, 0, -1), (1, 0, 0)])
def test_a_surface_at_any_angle_gets_its_light_the_better_the_more_suns_there_are(normal):
    environment = courtyard()
    truth = irradiance_of(environment, normal) @ LUMINANCE
    errors = [abs(irradiance(ir.directional_lights(environment, n), normal) @ LUMINANCE / truth - 1) for n in (10, 100, 1000)]
    assert errors[2] < 0.01 and errors[2] <= errors[0] < 0.25  # what a surface sees of a region that it cuts


def test_the_flux_of_all_suns_converges_to_the_environments_from_below():
    environment = courtyard()
    truth = sampled(environment)[1].sum((0, 1))
    shares = [sum(np.array(light.irradiance) for light in ir.directional_lights(environment, n)) / truth for n in (1, 10, 100, 1000)]
    assert all((a < b).all() for a, b in itertools.pairwise(shares))
    # A region of solid angle w keeps about 1 - w / (4 pi) of its flux: 1 - 1 / 200 at 100 equal ones; these are uneven and oblong.
    assert (shares[3] < 1).all() and shares[2] == pytest.approx(1, abs=0.04) and shares[3] == pytest.approx(1, abs=0.004)


def test_one_sun_for_a_constant_hemisphere_stands_in_the_zenith_and_halves_of_a_sphere_face_each_other():
    (sun,) = ir.directional_lights(ir.EnvironmentLight(radiance=(1, 2, 3)), 1)
    assert sun.direction == pytest.approx((0, -1, 0), abs=1e-6)
    assert sun.irradiance == pytest.approx((np.pi, 2 * np.pi, 3 * np.pi), rel=1e-6)
    two = ir.directional_lights(ir.EnvironmentLight(), 2, hemisphere=False)
    assert np.add(two[0].direction, two[1].direction) == pytest.approx((0, 0, 0), abs=1e-6)
    assert [light.irradiance[0] for light in two] == pytest.approx([np.pi, np.pi], rel=1e-6)
    (alone,) = ir.directional_lights(ir.EnvironmentLight(), 1, hemisphere=False)  # no net flux: no direction but up
    assert alone.direction == (0, -1, 0) and alone.irradiance == pytest.approx((np.pi,) * 3, rel=1e-6)


@pytest.mark.parametrize("count", COUNTS)
def test_suns_of_a_constant_hemisphere_are_about_as_strong_and_light_the_ground_exactly(count):
    lights = ir.directional_lights(ir.EnvironmentLight(), count)
    assert irradiance(lights, UP) == pytest.approx((np.pi,) * 3, rel=1e-6)
    strengths = [light.irradiance[0] for light in lights]
    # Halves of halves: twice as much at most, and half a row of texels.
    assert max(strengths) / min(strengths) < 2.4


def test_what_comes_from_below_counts_only_where_asked_for():
    environment = courtyard()
    around = ir.directional_lights(environment, 50, hemisphere=False)
    assert any(light.direction[1] > 0.3 for light in around)
    truth = irradiance_of(environment, -UP, hemisphere=False)
    assert irradiance(around, -UP) == pytest.approx(truth, rel=0.05)
    assert irradiance(ir.directional_lights(environment, 50), -UP) == pytest.approx(0, abs=1e-9)


def test_the_horizon_halves_the_middle_row_of_an_odd_image():
    image = np.zeros((129, 4, 3), np.float32)
    image[64] = 1
    lights = ir.directional_lights(ir.EnvironmentLight(image=image), 1)
    half = np.pi / 129 / 2
    assert irradiance(lights, UP) == pytest.approx((np.pi * np.sin(half) ** 2,) * 3, rel=1e-5)


def test_a_small_sun_is_one_light_and_black_is_none():
    image = np.zeros((128, 256, 3), np.float32)
    image[32, 64] = 1e4
    (sun,) = ir.directional_lights(ir.EnvironmentLight(image=image), 10)
    solid_angle = 2 * np.pi / 256 * (np.cos(32 * np.pi / 128) - np.cos(33 * np.pi / 128))
    assert sun.irradiance == pytest.approx((1e4 * solid_angle,) * 3, rel=1e-4)
    theta, phi = 32.5 * np.pi / 128, 64.5 * 2 * np.pi / 256 - np.pi
    assert sun.direction == pytest.approx((-np.sin(theta) * np.sin(phi), -np.cos(theta), np.sin(theta) * np.cos(phi)), abs=1e-4)
    assert ir.directional_lights(ir.EnvironmentLight(radiance=(0, 0, 0)), 10) == ()
    assert ir.directional_lights(ir.EnvironmentLight(image=0 * image), 10) == ()


def test_the_same_environment_gives_the_same_suns_the_strongest_region_first():
    first, second = (ir.directional_lights(courtyard(), 10) for _ in range(2))
    assert first == second
    strengths = [np.dot(light.irradiance, LUMINANCE) for light in first]
    assert strengths[0] > strengths[-1]


@pytest.mark.parametrize(("up", "rotation"), [((0, 1, 0), 0), ((0, 1, 0), 130), ((0, 0, 1), -40)])
def test_a_ball_in_the_suns_looks_like_a_ball_under_the_environment(up, rotation):
    """As the core sees both: which way is up, and where the image's centre lies."""
    image = courtyard(32).image.copy()
    image[16:] = 0  # the whole of it is above the horizon
    environment = ir.EnvironmentLight(image=image, rotation=rotation)
    ball = ir.scenes.lone_ball(0.3)
    camera = ir.Camera(position=np.asarray(ball.camera.position) * 0.8 + 0.3, target=(0, 0, 0), up=(0.1, 0.9, 0.2), fov_x=40)

    def seen(lights):
        scene = ir.Scene(meshes=ball.meshes, lights=lights, cameras={"view": camera}, up=up)
        return ir.methods.PathTracing(spp=256, bounces=0).render(scene, size=(24, 24)).image

    seen_material = ir.trace_gbuffer(ball.replace(cameras={"view": camera}), size=(24, 24)).albedo
    body = np.asarray(seen_material)[..., 0] > 0.5
    sky, suns = (seen(lights)[body] for lights in ([environment], ir.directional_lights(environment, 256, up=up)))
    # Bilinear look-ups blur texels of 6 degrees, and 256 samples are noisy.
    assert np.abs(suns - sky).mean() / sky.mean() < 0.035  # 30 degrees of rotation make 0.06
    assert suns.mean(0) == pytest.approx(sky.mean(0), rel=0.03)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"environment": "sky"}, "environment must be an EnvironmentLight, got str"),
        ({"count": 0}, r"count must be a whole number in \[1, 4096\], got 0"),
        ({"count": 4097}, r"count must be a whole number in \[1, 4096\], got 4097"),
        ({"count": 2.5}, "count must be a whole number"),
        ({"hemisphere": "upper"}, "hemisphere must be true or false, got 'upper'"),
        ({"up": (0, 0, 0)}, "up must not have zero length"),
        ({"up": (0, float("nan"), 0)}, "up must be three finite numbers"),
    ],
)
def test_wrong_arguments_are_refused_by_name_bound_and_value(arguments, message):
    given = {"environment": ir.EnvironmentLight(), "count": 10} | arguments
    with pytest.raises(ValueError, match=f"^{message}"):
        ir.directional_lights(given.pop("environment"), given.pop("count"), **given)
