"""What must hold of path tracing whatever the scene: linearity, invariance, exact bounces, the same bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import interreflect as ir

SIZE = (40, 30)


@pytest.fixture(scope="module")
def scene() -> ir.Scene:
    """A Cornell box with an area light, a point light and a glossy box: every kind of vertex."""
    box = ir.scenes.cornell_box()
    low, high = box.bounds
    return box.replace(lights=[ir.PointLight(position=tuple(low + (high - low) * (0.3, 0.7, 0.6)), intensity=(1.0, 0.5, 0.25))])


def trace(scene: ir.Scene, spp: int = 4, size: tuple[int, int] = SIZE, seed: int = 0, threads: int | None = None, **knobs: Any) -> Any:
    return ir.methods.PathTracing(spp=spp, **knobs).render(scene, size=size, seed=seed, threads=threads)


def lights_scaled(scene: ir.Scene, factor: float) -> ir.Scene:
    emitting = {m.material.name: {"emission": tuple(factor * e for e in m.material.emission)} for m in scene.meshes if m.material.emits}
    lights = [ir.PointLight(position=light.position, intensity=tuple(factor * v for v in light.intensity)) for light in scene.lights]  # type: ignore[union-attr]
    return scene.replace(lights=lights, materials=emitting)


def moved(scene: ir.Scene, scale: float, offset: NDArray[np.float64]) -> ir.Scene:
    """The same picture of a scene that is larger by `scale` and stands elsewhere: intensities grow with the square."""

    def place(p: Any) -> tuple[float, ...]:
        return tuple(float(v) for v in np.asarray(p) * scale + offset)

    meshes = [
        ir.Mesh(
            (m.positions * scale + offset).astype(np.float32), m.triangles, normals=m.normals, texcoords=m.texcoords, material=m.material
        )
        for m in scene.meshes
    ]
    lights = [
        ir.PointLight(position=place(light.position), intensity=tuple(scale**2 * v for v in light.intensity))  # type: ignore[union-attr]
        for light in scene.lights
    ]
    view = scene.camera
    camera = ir.Camera(position=place(view.position), target=place(view.target), up=view.up, fov_x=view.fov_x)
    return ir.Scene(meshes=meshes, lights=lights, cameras={"view": camera}, name=scene.name)


@pytest.mark.parametrize("bounces", [1, None])
def test_the_same_bits_at_one_thread_and_at_two(scene: ir.Scene, bounces: int | None) -> None:
    one, two = (trace(scene, bounces=bounces, size=(100, 70), threads=n) for n in (1, 2))
    assert np.array_equal(one.direct, two.direct)
    assert np.array_equal(one.indirect, two.indirect)


def test_the_same_seed_gives_the_same_bits_and_another_seed_others(scene: ir.Scene) -> None:
    first, again, other = (trace(scene, seed=seed).image for seed in (1, 1, 2))
    assert np.array_equal(first, again)
    assert not np.array_equal(first, other)


def test_the_picture_is_linear_in_the_light(scene: ir.Scene) -> None:
    # a power of two: float arithmetic does the same up to the exponent; roulette looks at throughput, not at light
    once, twice = trace(scene, bounces=None), trace(lights_scaled(scene, 4.0), bounces=None)
    np.testing.assert_allclose(twice.image, 4 * once.image, rtol=1e-6)


def test_without_light_the_picture_is_black(scene: ir.Scene) -> None:
    assert trace(lights_scaled(scene, 0.0), bounces=None).image.max() == 0


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_a_scene_of_another_size_gives_the_same_picture(scene: ir.Scene, scale: float) -> None:
    a, b = trace(scene, bounces=2).image, trace(moved(scene, scale, np.zeros(3)), bounces=2).image
    # the same random numbers; rounding moves a path across an edge now and then
    assert np.mean(np.abs(a - b) > 1e-3 * (a + a.mean())) < 0.01
    assert a.mean() == pytest.approx(b.mean(), rel=5e-3)


def test_a_scene_a_hundred_extents_away_gives_the_same_picture(scene: ir.Scene) -> None:
    extent = float(np.ptp(scene.bounds, axis=0).max())
    a, b = trace(scene, spp=16, bounces=2).image, trace(moved(scene, 1, np.full(3, 100 * extent)), spp=16, bounces=2).image
    # positions have 1e-5 of the extent left at that distance
    assert np.mean(np.abs(a - b) > 1e-2 * (a + a.mean())) < 0.05
    assert a.mean() == pytest.approx(b.mean(), rel=1e-2)


def test_each_bounce_adds_light_and_all_of_them_add_up(scene: ir.Scene) -> None:
    images = [trace(scene, spp=64, bounces=n) for n in (0, 1, 2, 3)]
    assert images[0].indirect.max() == 0
    means = [image.image.mean() for image in images]
    added = np.diff(means)
    assert (added > 0).all() and (np.diff(added) < 0).all()
    # Every bounce keeps about the same share of the one before, so the rest is close to a geometric series.
    total = means[3] + added[2] * (added[2] / added[1]) / (1 - added[2] / added[1])
    assert trace(scene, spp=64, bounces=None).image.mean() == pytest.approx(total, rel=0.02)


def test_more_bounces_leave_what_the_first_ones_brought(scene: ir.Scene) -> None:
    # the same random numbers for the same vertex: bounce n + 1 only adds; the last vertex weighs its light samples otherwise
    one, two = (trace(scene, spp=256, bounces=n) for n in (1, 2))
    assert two.direct.mean() == pytest.approx(one.direct.mean(), rel=5e-3)
    blocks = (two.indirect - one.indirect)[:24, :40].reshape(3, 8, 5, 8, 3).mean((1, 3))
    assert blocks.min() > -0.02 * one.indirect.mean()


def test_centre_and_box_agree_where_the_picture_is_smooth(scene: ir.Scene) -> None:
    # indirect light: the edges of the light itself fill pixels partly, which only the box sees
    a, b = (trace(scene, spp=64, bounces=1, pixel=pixel).indirect for pixel in ("centre", "box"))
    assert np.median(np.abs(a - b) / (a + a.mean())) < 0.05
    assert a.mean() == pytest.approx(b.mean(), rel=0.03)


@pytest.mark.parametrize("pattern", [1, 3, 32])
def test_sharing_random_numbers_between_pixels_leaves_the_mean(scene: ir.Scene, pattern: int) -> None:
    def means(**knobs: Any) -> NDArray[np.float64]:
        return np.array([trace(scene, spp=8, seed=seed, bounces=1, **knobs).image.mean(dtype=np.float64) for seed in range(16)])

    a, b = means(), means(pattern=pattern)
    error = np.sqrt((a.var(ddof=1) + b.var(ddof=1)) / 16)
    assert abs(a.mean() - b.mean()) < 5 * error


def test_a_time_budget_ends_the_picture_and_keeps_its_mean(scene: ir.Scene) -> None:
    few = trace(scene, milliseconds=1.0, bounces=1)
    assert few.profile.stages["path_trace"].counts["paths"] >= SIZE[0] * SIZE[1]
    assert trace(scene, milliseconds=300.0, bounces=1).image.mean() == pytest.approx(trace(scene, spp=64, bounces=1).image.mean(), rel=0.05)


@pytest.mark.parametrize(
    "surface",
    [
        {"albedo": (0.99, 0.99, 0.99)},
        {"albedo": (0.0, 0.0, 0.0), "specular": (0.99, 0.99, 0.99), "roughness": 0.0},
        {"albedo": (0.2, 0.2, 0.2), "specular": (0.7, 0.7, 0.7), "lobe": "phong", "exponent": 1000},
        {"albedo": (0.0, 0.0, 0.0)},
    ],
)
def test_extreme_materials_stay_finite(scene: ir.Scene, surface: dict[str, Any]) -> None:
    for bounces in (0, 2, None):
        image = trace(scene.replace(materials={"*": {"albedo_map": None, **surface}}), bounces=bounces).image
        assert np.isfinite(image).all() and image.min() >= 0


def test_a_scene_without_anything_is_black() -> None:
    empty = ir.Scene(cameras={"view": ir.Camera(position=(0, 0, 1), target=(0, 0, 0), fov_x=60)})
    assert trace(empty, bounces=None).image.max() == 0
