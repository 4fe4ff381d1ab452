"""Closed forms over every integrator to which they apply."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect as ir

CASES = [
    (1, {}), (1, {"shape": "sphere", "bounces": 0}), (1, {"albedo": 0.8, "bounces": 0}),
    (2, {}), (2, {"bounces": 0}),
    (3, {}), (3, {"part": "direct"}), (3, {"part": "indirect"}),
    (4, {}), (4, {"bounces": None}), (4, {"cap": 60}),
    (5, {}), (5, {"distance": 0.5}), (6, {}), (7, {}), (7, {"other_radius": 0.5, "distance": 2}),
    (8, {}), (8, {"offset": 1}), (9, {}), (10, {}), (11, {}), (12, {}), (13, {}), (13, {"bounces": 0}),
    (14, {}), (15, {}), (17, {}), (17, {"alpha": 0.25}),
]  # fmt: skip
SEEDS = range(8)
STAGE_SAMPLES = {10: 64, 13: 48}
SPP = {4: 32, 10: 64, 13: 48}  # noisier than the rest, which take 8


def path_tracing(**knobs):
    def pictures(case, seed):
        method = ir.methods.PathTracing(spp=SPP.get(case.row, 8), bounces=case.bounces, **knobs)
        return [method.render(case.scene, camera=name, size=case.size, seed=seed) for name in case.cameras]

    return pictures


class Reflected:
    """Light after at most one reflection, by the stages that find it at the pixels of a G-buffer."""

    def __init__(self, case, name, seed):
        gbuffer = ir.trace_gbuffer(case.scene, name, case.size)
        samples = STAGE_SAMPLES.get(case.row, 8)
        lit = ir.shadow(ir.TracedShadows(samples=samples), case.scene, gbuffer, seed)
        open_sky = ir.sky(ir.TracedSky(samples=samples), case.scene, gbuffer, seed)
        self.image = self.direct = np.asarray(gbuffer.emission) + lit.radiance + open_sky.radiance


def stages(case, seed):
    return [Reflected(case, name, seed) for name in case.cameras]


INTEGRATORS = {
    "path tracing at pixel centres": path_tracing(pattern=32),
    "traced shadows and traced sky": stages,
    "path tracing over whole pixels": path_tracing(pixel="box", pattern=32),
}


def applies(integrator, row, knobs):
    """The stages of direct light end at the first reflection."""
    once = row not in (1, 2, 3, 4, 13) or knobs.get("bounces") == 0 or knobs.get("part") == "direct"
    return once or integrator != "traced shadows and traced sky"


@pytest.mark.parametrize(("row", "knobs", "integrator"), [(*c, name) for name in INTEGRATORS for c in CASES if applies(name, *c)])
def test_a_picture_shows_the_closed_form(row, knobs, integrator):
    case = ir.scenes.closed_form(row, **knobs)
    values = np.array([case.measure(*INTEGRATORS[integrator](case, seed)) for seed in SEEDS])
    noise = values.std(ddof=1) / np.sqrt(len(values))
    assert noise < 0.005 * case.value, "too noisy to tell"
    # 5.4 standard errors: one test in a thousand, by Student's t of 8 seeds
    assert abs(values.mean() - case.value) < case.tolerance * case.value + 5.4 * noise, (values.mean(), case.value, noise)


@pytest.mark.parametrize("row", [5, 6])
def test_a_measuring_camera_sees_its_square_and_nothing_else(row):
    case = ir.scenes.closed_form(row)
    gbuffer = ir.trace_gbuffer(case.scene, case.scene.cameras[case.camera], (50, 50))
    position = np.asarray(gbuffer.position)
    centres = (np.arange(50) + 0.5) / 50 - 0.5
    assert np.asarray(gbuffer.albedo) == pytest.approx(0.5)
    assert np.unique(np.round(position[..., 0], 4)) == pytest.approx(centres, abs=1e-4)
    assert np.unique(np.round(position[..., 2], 4)) == pytest.approx(centres, abs=1e-4)


def test_only_spherical_harmonics_are_not_light():
    assert [row for row in range(1, 18) if ir.scenes.closed_form(row).transport != "light"] == [16]


@pytest.mark.parametrize("light_voxels", [ir.TracedLighting(both_sides=True), ir.ShadowMapInjection(both_sides=True)], ids=repr)
@pytest.mark.parametrize(("row", "knobs"), [(4, {}), (4, {"cap": 60}), (3, {"part": "indirect"})])
def test_rays_through_voxels_gather_one_bounce_as_the_closed_form_says(row, knobs, light_voxels):
    case = ir.scenes.closed_form(row, **knobs)
    method = ir.methods.VoxelConeTracing(light_voxels=light_voxels, march=ir.TracedRays(samples=16), share=ir.EveryPixel())
    values = np.array([case.measure(method.render(case.scene, camera=case.camera, size=(64, 64), seed=seed)) for seed in range(6)])
    noise = values.std(ddof=1) / np.sqrt(len(values))
    # A voxel is 1/64 of the radius: light is stored up to half of that beside where it falls, 1/128 of its distance.
    assert abs(values.mean() - case.value) < case.value / 128 + 4 * noise, (values, case.value)


@pytest.mark.parametrize(("cap", "resolution"), [(30, 4), (30, 16), (30, 32), (45, 16)])
def test_caches_that_rays_fill_show_every_wall_the_irradiance_of_the_closed_form(cap, resolution):
    """In the cap light arrives from along the wall, where a map's texels reach from the horizon far up."""
    case = ir.scenes.closed_form(4, cap=cap)
    fill = ir.TracedFill(resolution=resolution, samples=4096 // resolution**2)
    method = ir.methods.ClusteredRadianceCaching(grid=ir.Grid(resolution=64), fill=fill, interpolate=ir.Evaluated())
    frame = method.render(case.scene, camera=case.camera, size=(40, 40), seed=1)
    lit = np.asarray(frame.direct)[..., 0] > 0
    indirect = np.asarray(frame.indirect)[..., 0] * case.scale / case.value
    assert 200 < lit.sum() < 1400
    # Measured 1.000 to 1.008; with texels that are means over their solid angle 1.03 to 1.07 in the cap (1.9 with 4 x 4 of them) and
    # .99 around it. A voxel is 1/64 of the radius, light lies up to half of that beside where it falls; facets tilt normals by 1.3 degrees.
    assert indirect[lit].mean() == pytest.approx(1.0, abs=0.0125)
    assert indirect[~lit].mean() == pytest.approx(1.0, abs=0.0125)
    assert indirect.mean() == pytest.approx(1.0, abs=1 / 128)
