"""The scene of Rehfeld et al.'s pictures: as large, as glossy and as lit as the paper says, and nothing sunk or afloat."""

import numpy as np
import pytest
from experiments.shared import two_cars as scenes
from experiments.shared.suns import sky

import interreflect as ir

SMALL = (120, 79)


@pytest.fixture(scope="module")
def scene():
    try:
        return scenes.two_cars()
    except FileNotFoundError as absent:
        pytest.skip(str(absent))


def points(scene, body):
    """World positions of a body's used vertices, (n, 3) for each mesh."""
    for mesh in scene.meshes:
        if mesh.body == body:
            pose = scene.bodies[body] @ mesh.transform
            yield mesh.positions[np.unique(mesh.triangles)] @ pose[:3, :3].T + pose[:3, 3]


def test_it_is_as_large_as_the_papers_and_shares_the_second_cars_arrays(scene):
    assert scene.triangles == pytest.approx(1.9e6, rel=0.03)
    cars = [[mesh for mesh in scene.meshes if mesh.body == body] for body in ("car", "car.1")]
    assert len(cars[0]) == len(cars[1]) > 90
    assert all(a.positions is b.positions for a, b in zip(*cars, strict=True))
    assert scenes.two_cars() is scene  # loaded once


def test_every_material_is_phong_and_keeps_its_energy(scene):
    for material in {mesh.material for mesh in scene.meshes}:
        assert (material.lobe, material.exponent) == ("phong", 50)
        assert min(material.specular) >= 0.2
        brightest = np.array(material.albedo) * (0.8 if material.albedo_map is not None else 1)  # maps stay below .8
        assert (brightest + material.specular <= 1 + 1e-6).all(), material.name


@pytest.mark.parametrize("body", ["car", "car.1"])
def test_cars_stand_on_the_floor_with_four_wheels_inside_the_court(scene, body):
    corners = np.concatenate(list(points(scene, body)))
    low, high = corners.min(0), corners.max(0)
    assert low[1] == pytest.approx(0, abs=1e-5)
    assert high[1] - low[1] == pytest.approx(1.39, abs=0.02)  # height of the car, m
    assert (low > (-0.1, -1, -2.7)).all() and (high < (7.5, 2, 2.7)).all()  # fountain, arcades on either side, camera
    local = (corners - scene.bodies[body][:3, 3]) @ scene.bodies[body][:3, :3]
    feet = local[corners[:, 1] < 0.01]
    assert {(x > 0, z > 0) for x, z in zip(feet[:, 0], feet[:, 2], strict=True)} == {(a, b) for a in (False, True) for b in (False, True)}


def test_cars_do_not_touch(scene):
    """A line between them leaves each on its own side."""
    sides = [np.concatenate(list(points(scene, body)))[:, [0, 2]] for body in ("car", "car.1")]
    angles = np.radians(np.arange(0, 180, 2))
    gaps = [(sides[1] @ axis).min() - (sides[0] @ axis).max() for axis in np.stack([np.cos(angles), np.sin(angles)], 1)]
    assert max(gaps) > 0.1


def test_ten_suns_reach_floor_and_cars(scene):
    assert len(scene.lights) == 10 and all(light.direction[1] < -0.05 for light in scene.lights)
    gbuffer = ir.trace_gbuffer(scene, "cars", SMALL)
    image = ir.methods.PathTracing(spp=4, bounces=0).render(scene, "cars", size=SMALL).image
    assert np.isfinite(image).all()
    body, floor = np.asarray(gbuffer.body), np.asarray(gbuffer.position)[..., 1] < 0.2
    lit = image.mean(2) > 0.02
    assert all((body == k).mean() > 0.08 for k in (1, 2))  # both cars are in the picture
    assert lit[body > 0].mean() > 0.35 and lit[(body == 0) & floor].mean() > 0.6


def test_ten_suns_carry_most_of_what_four_hundred_do(scene):
    """A sun keeps what its region brings to a surface that faces it, which is less than the region's flux."""
    fewer, more = (sum(np.array(light.irradiance) for light in sky(n)) for n in (10, 400))
    assert fewer == pytest.approx(more, rel=0.15) and (fewer < more).all()


def test_other_exponents_change_the_lobe_alone(scene):
    sharper = scenes.two_cars(150.0)
    assert {mesh.material.exponent for mesh in sharper.meshes} == {150}
    assert sharper.lights == scene.lights and sharper.triangles == scene.triangles
