"""Direct light twice: the stages that find it at the pixels of a G-buffer, and path tracing that stops after the first reflection."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

import interreflect as ir

sys.path.insert(0, str(Path(__file__).parents[1] / "statistics"))

from welch import compare

SEEDS = range(6)
SIZE = (96, 72)


def lamp_in_a_shiny_floor() -> ir.Scene:
    """A lamp seen in a lobe so narrow that light samples and the lobe's own find it about as well."""
    lamp = ir.Mesh(
        np.array([[-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]], np.float32),
        np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        material=ir.Material(albedo=(0.0,) * 3, emission=(2.0,) * 3),
    )
    floor = ir.Mesh(
        np.array([[-2, 0, 2], [2, 0, 2], [2, 0, -2], [-2, 0, -2]], np.float32),
        np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
        material=ir.Material(albedo=(0.2,) * 3, specular=(0.7,) * 3, roughness=0.4),
    )
    return ir.Scene(meshes=[floor, lamp], cameras={"view": ir.Camera(position=(0, 0.5, 1.5), target=(0, 0, -0.2), fov_x=50)})


SCENES = {
    "lamp in a shiny floor": lamp_in_a_shiny_floor,
    "Cornell box": lambda: ir.scenes.cornell_box(),
    "glossy Cornell box": lambda: ir.scenes.cornell_box(box="glossy"),
    "atrium": lambda: ir.scenes.atrium(),
}


def by_stages(scene: ir.Scene, gbuffer: ir.GBuffer, seed: int) -> np.ndarray:
    lit = ir.shadow(ir.TracedShadows(samples=16), scene, gbuffer, seed)
    open_sky = ir.sky(ir.TracedSky(samples=16, filter_radius=0), scene, gbuffer, seed)  # a filter would be biased
    return np.asarray(gbuffer.emission) + lit.radiance + open_sky.radiance


@pytest.mark.parametrize("name", SCENES)
def test_traced_shadows_and_sky_and_emission_are_path_tracing_without_bounces(name: str) -> None:
    scene = SCENES[name]()
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    stages = np.stack([by_stages(scene, gbuffer, seed) for seed in SEEDS])
    tracing = ir.methods.PathTracing(spp=16, bounces=0).prepare(scene)
    frames = [tracing.render(size=SIZE, seed=seed) for seed in SEEDS]
    assert max(frame.indirect.max() for frame in frames) == 0
    found = compare(stages, np.stack([frame.image for frame in frames]))
    # A true null has 1e-3 of its tests below 1e-3: of 324, two are already one in twenty, and six are one in 50,000.
    assert (found.p_values < 1e-3).sum() < 6
    # Ten degrees of freedom: 5 standard errors are one in two thousand. 2e-4: what rounding moves across edges of sharp shadows.
    assert abs(found.mean_difference) < 5 * found.mean_error + 2e-4


@pytest.mark.parametrize("light", ["point", "spot"])
def test_without_noise_the_two_agree_to_the_last_digits(light: str) -> None:
    scene = ir.scenes.cornell_box(light=light, box="glossy")
    stages = by_stages(scene, ir.trace_gbuffer(scene, size=SIZE), 0)
    traced = ir.methods.PathTracing(spp=1, bounces=0).render(scene, size=SIZE).image
    differ = np.abs(stages - traced).max(-1) > 1e-4 * stages.max()
    assert differ.mean() < 1e-3  # a shadow's edge within rounding of a pixel's centre: seven pixels of 6912
    assert stages.mean() == pytest.approx(traced.mean(), rel=1e-4)
