"""Contracts of the stages shadow and sky, and of reflective shadow maps."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core

SIZE = (48, 36)
SUN = ir.DirectionalLight(direction=(-0.3, -1, -0.2), irradiance=(3, 2, 1))
LIGHTS = {
    "directional": SUN,
    "point": ir.PointLight(position=(0.4, 1.5, 0.3), intensity=(3, 2, 1)),
    "spot": ir.SpotLight(position=(0.4, 1.5, 0.3), direction=(-0.2, -1, -0.1), intensity=(3, 2, 1), inner=25, outer=40),
    "wide spot": ir.SpotLight(position=(0.4, 1.5, 0.3), direction=(-0.2, -1, -0.1), intensity=(3, 2, 1), inner=60, outer=85),
}
SHADOWS = [ir.TracedShadows(), ir.ShadowMap(size=64), ir.VoxelCones()]
BOX = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32)
BOX_FACES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]],
    np.uint32,
)


def floor(half=3.0, **knobs):
    positions = half * np.array([[-1, 0, -1], [1, 0, -1], [1, 0, 1], [-1, 0, 1]], np.float32)
    return ir.Mesh(positions, np.array([[0, 2, 1], [0, 3, 2]], np.uint32), **knobs)


def scene(*lights, scale=1.0, move=(0, 0, 0), glossy=False, extra=()):
    """A floor with a box on it; everything times `scale`, then moved."""
    material = ir.Material(albedo=(0.6, 0.5, 0.4), specular=(0.2, 0.2, 0.2) if glossy else (0, 0, 0), roughness=0.6)
    offset = np.asarray(move, np.float64)

    def place(mesh):
        return replace(mesh, positions=(mesh.positions.astype(np.float64) * scale + offset).astype(np.float32), material=material)

    box = ir.Mesh((BOX - [0.5, 0, 0.5]) * np.float32(0.5), BOX_FACES)
    meshes = [floor(), box]
    camera = ir.Camera(position=scale * np.array((1.5, 2.0, 2.5)) + offset, target=scale * np.array((0, 0.2, 0)) + offset, fov_x=55)
    moved = []
    for light in lights:
        change = {}
        if hasattr(light, "position"):
            change["position"] = tuple(scale * np.array(light.position) + offset)
            change["intensity"] = tuple(scale**2 * np.array(light.intensity))
        moved.append(replace(light, **change))
    return ir.Scene(meshes=[*map(place, meshes), *extra], lights=moved, cameras={"view": camera})


def pyramids(technique, of):
    """What VoxelCones march through."""
    if not isinstance(technique, ir.VoxelCones):
        return []
    voxels = ir.voxelize(ir.ExactOverlap(), of, ir.Grid(resolution=32).place(of))
    return [ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(), of, voxels))]


def shadow(technique, of, seed=0, size=SIZE):
    return np.array(ir.shadow(technique, of, ir.trace_gbuffer(of, size=size), seed, pyramids(technique, of)).radiance)


def sky(technique, of, seed=0, size=SIZE):
    return np.array(ir.sky(technique, of, ir.trace_gbuffer(of, size=size), seed).radiance)


@pytest.mark.parametrize("technique", SHADOWS)
def test_a_lambertian_plane_reflects_albedo_times_irradiance_times_cosine_over_pi(technique):
    camera = ir.Camera(position=(0, 2, 0.1), target=(0, 0, 0), fov_x=60)
    light = ir.DirectionalLight(direction=(np.sin(np.radians(60)), -np.cos(np.radians(60)), 0), irradiance=(np.pi, 1, 2))
    open_floor = ir.Scene(meshes=[floor(material=ir.Material(albedo=(0.5, 0.2, 0.8)))], lights=[light], cameras={"c": camera})
    expected = np.array([0.5, 0.2, 0.8]) * [np.pi, 1, 2] * 0.5 / np.pi  # GROUND_TRUTH row 14
    assert shadow(technique, open_floor) == pytest.approx(np.broadcast_to(expected, (*SIZE[::-1], 3)), rel=1e-5)


@pytest.mark.parametrize("radius", [0, 3])
def test_an_open_plane_reflects_albedo_times_the_sky(radius):
    camera = ir.Camera(position=(0, 2, 0.1), target=(0, 0, 0), fov_x=60)
    environment = ir.EnvironmentLight(radiance=(1, 2, 3))
    open_floor = ir.Scene(meshes=[floor()], lights=[environment], cameras={"c": camera})
    # Cosine-distributed rays that all escape have no variance.
    image = sky(ir.TracedSky(samples=2, filter_radius=radius), open_floor)
    assert image == pytest.approx(np.broadcast_to(0.5 * np.array([1, 2, 3]), image.shape), rel=1e-5)


def test_an_image_that_is_the_same_everywhere_lights_like_a_constant_sky():
    camera = ir.Camera(position=(0, 2, 0.1), target=(0, 0, 0), fov_x=60)
    image = ir.EnvironmentLight(radiance=(1, 2, 3), image=np.ones((8, 16, 3), np.float32))
    open_floor = ir.Scene(meshes=[floor()], lights=[image], cameras={"c": camera})
    values = np.array([sky(ir.TracedSky(samples=16), open_floor, seed).mean((0, 1)) for seed in range(4)])
    noise = values.std(0, ddof=1) / 2
    assert np.all(noise < 2e-3 * values.mean(0))
    assert np.all(np.abs(values.mean(0) - 0.5 * np.array([1, 2, 3])) < 12 * noise)  # Student's t of 4 seeds, one in a thousand


def test_under_a_roof_that_covers_the_sky_no_sky_arrives():
    above = floor(50)
    roof = replace(above, positions=above.positions + np.float32([0, 4, 0]))
    camera = ir.Camera(position=(1, 1, 1), target=(0, 0, 0), fov_x=60)
    covered = ir.Scene(meshes=[floor(), roof], lights=[ir.EnvironmentLight(radiance=(1, 1, 1))], cameras={"below": camera})
    # The roof is 100 wide, 4 above the floor: 1 - (50 / sqrt(50^2 + 4^2))^2 = 0.6 % of the irradiance passes at its sides.
    assert sky(ir.TracedSky(samples=16), covered).mean() < 0.01 * 0.5


@pytest.mark.parametrize("light", LIGHTS)
@pytest.mark.parametrize("glossy", [False, True])
def test_shadow_maps_converge_to_traced_shadows(light, glossy):
    lit = scene(LIGHTS[light], glossy=glossy)
    truth = shadow(ir.TracedShadows(), lit, size=(160, 120))
    assert 0.02 < (truth.max(-1) > 0).mean() < 0.98, "light and shadow are both in the picture"
    errors = [np.abs(shadow(ir.ShadowMap(size=n), lit, size=(160, 120)) - truth).mean() / truth.mean() for n in (32, 128, 512)]
    assert errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]  # a border's width, so nearly a quarter each
    assert errors[2] < 0.02


@pytest.mark.parametrize("technique", [*SHADOWS, ir.TracedSky(), ir.TracedSky(filter_radius=2)])
def test_threads_change_no_bit_and_the_seed_is_the_only_chance(technique):
    emitter = floor(0.3, material=ir.Material(emission=(5, 4, 3)))
    emitter = replace(emitter, positions=emitter.positions * np.float32([1, 1, -1]) + np.float32([0, 2, 0]))
    everything = scene(*LIGHTS.values(), ir.EnvironmentLight(radiance=(1, 1, 1)), glossy=True, extra=[emitter])
    stage = sky if isinstance(technique, ir.TracedSky) else shadow
    images = []
    for threads in (1, 2, None):
        with _core.Threads(threads):
            images.append(stage(technique, everything, seed=3))
    assert np.array_equal(images[0], images[1]) and np.array_equal(images[0], images[2])
    assert not np.array_equal(images[0], stage(technique, everything, seed=4))


@pytest.mark.parametrize("technique", [*SHADOWS, ir.TracedSky()])
def test_twice_the_light_reflects_twice_as_much_and_none_none(technique):
    stage = sky if isinstance(technique, ir.TracedSky) else shadow

    def lights(factor):
        def scaled(light):
            name = "irradiance" if light is SUN else "intensity"
            return replace(light, **{name: tuple(factor * np.array(getattr(light, name)))})

        return [*map(scaled, LIGHTS.values()), ir.EnvironmentLight(radiance=(factor, factor, factor))]

    once, twice, none = (stage(technique, scene(*lights(f), glossy=True)) for f in (1, 2, 0))
    assert np.array_equal(twice, 2 * once) and once.max() > 0
    assert not none.any()


@pytest.mark.parametrize("scale", [1e-3, 1e3])
@pytest.mark.parametrize("technique", SHADOWS)
def test_scaling_scene_and_lights_changes_no_picture(technique, scale):
    lights = list(LIGHTS.values())
    before, after = shadow(technique, scene(*lights)), shadow(technique, scene(*lights, scale=scale))
    # Rounding moves single pixels across an edge of a shadow; all others agree.
    differs = np.abs(before - after).max(-1) > 1e-3 * before.max()
    assert differs.mean() < 0.005


@pytest.mark.parametrize("technique", SHADOWS)
def test_moving_everything_by_100_extents_changes_no_picture(technique):
    lights = list(LIGHTS.values())
    before, after = shadow(technique, scene(*lights)), shadow(technique, scene(*lights, move=(600, -600, 600)))
    # Coordinates of 600 leave 6e-5 of a place, a pixel being 0.06 wide: edges move by a thousandth of a pixel and self-shadowing
    # starts 2^-18 of 600 off the surface.
    differs = np.abs(before - after).max(-1) > 1e-2 * before.max()
    assert differs.mean() < 0.02


def test_traced_shadows_of_an_emitter_follow_its_form_factor():
    case = ir.scenes.closed_form(12)
    gbuffer = ir.trace_gbuffer(case.scene, case.camera, case.size)
    few = [np.asarray(ir.shadow(ir.TracedShadows(samples=n), case.scene, gbuffer, 0).radiance) for n in (1, 64)]
    assert few[1].std() < few[0].std() / 6 or few[0].std() < 1e-3  # stratified: at least as the square root of the samples


def test_the_filter_of_the_sky_does_not_mix_the_faces_of_a_box():
    under = scene(ir.EnvironmentLight(radiance=(1.0,) * 3))
    gbuffer = ir.trace_gbuffer(under, size=(96, 72))
    top = (np.asarray(gbuffer.normal)[..., 1] > 0.9) & (np.asarray(gbuffer.position)[..., 1] > 0.4)
    image = sky(ir.TracedSky(samples=4, filter_radius=2), under, size=(96, 72))
    # Nothing hides the sky from the top, a side sees half of it; the floor beside, far below, weighs less than 1e-3.
    assert top.sum() > 50 and (image[top] / [0.6, 0.5, 0.4]).min() > 0.999


def test_a_reflective_shadow_map_holds_the_flux_that_the_scene_catches():
    spot = ir.SpotLight(position=(0, 2, 0), direction=(0, -1, 0), intensity=(2, 4, 6), inner=20, outer=30)
    lit = scene(spot)
    flux = np.asarray(_core.reflective_shadow_map(lit.core, 0, 256).incident).sum((0, 1), dtype=np.float64)
    cosines = np.linspace(np.cos(np.radians(30)), 1, 100001)
    t = np.clip((cosines - np.cos(np.radians(30))) / (np.cos(np.radians(20)) - np.cos(np.radians(30))), 0, 1)
    caught = 2 * np.pi * np.trapezoid(t * t * (3 - 2 * t), cosines)  # the floor is wider than the cone
    assert flux == pytest.approx(caught * np.array([2, 4, 6]), rel=2e-3)  # 256 texels across the cone
    # The sun: what falls on the floor's own 36 square units, whatever stands on it.
    sunlit = _core.reflective_shadow_map(scene(SUN).core, 0, 512)
    direction = np.array(SUN.direction) / np.linalg.norm(SUN.direction)
    expected = 36 * -direction[1] * np.array(SUN.irradiance)
    assert np.asarray(sunlit.incident).sum((0, 1), dtype=np.float64) == pytest.approx(expected, rel=1e-2)
    solid = np.asarray(sunlit.normal).any(-1)
    assert np.array_equal(solid, np.asarray(sunlit.flux).any(-1))
    assert (np.asarray(sunlit.normal)[solid] @ direction < 0).all()  # on the side that the sun sees
    assert np.allclose(np.asarray(sunlit.flux)[solid], np.asarray(sunlit.incident)[solid] * [0.6, 0.5, 0.4], rtol=1e-5)
    with pytest.raises(ValueError, match="spot or directional"):
        _core.reflective_shadow_map(scene(LIGHTS["point"]).core, 0, 16)
    with pytest.raises(ValueError, match="75 degrees"):
        _core.reflective_shadow_map(scene(LIGHTS["wide spot"]).core, 0, 16)


def test_the_sky_of_cones_is_albedo_over_pi_times_what_they_gathered():
    lit = scene(SUN, glossy=True)
    gbuffer = ir.trace_gbuffer(lit, size=SIZE)
    rng = np.random.default_rng(1)
    gathered, lobe = (SimpleNamespace(sky=rng.random((*SIZE[::-1], 3), np.float32)) for _ in range(2))
    hit = (np.asarray(gbuffer.triangle) != 2**32 - 1)[..., None]
    diffuse = np.asarray(gbuffer.albedo) / np.pi * gathered.sky * hit
    assert np.asarray(_core.cone_sky(gbuffer, gathered, None).radiance) == pytest.approx(diffuse, rel=1e-5)
    both = np.asarray(_core.cone_sky(gbuffer, gathered, lobe).radiance)
    assert both == pytest.approx(diffuse + lobe.sky * hit, rel=1e-5)
    with pytest.raises(ValueError, match=r"gathered\.sky"):
        _core.cone_sky(gbuffer, SimpleNamespace(sky=np.zeros((2, 2, 3), np.float32)), None)


def test_views_of_a_gbuffer_outlive_it_and_cannot_be_written():
    lit = scene(SUN)
    position = ir.trace_gbuffer(lit, size=SIZE).position
    again = ir.trace_gbuffer(lit, size=SIZE).position
    assert np.array_equal(position, again)
    with pytest.raises(ValueError):
        position[0, 0] = 0
