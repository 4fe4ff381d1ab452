"""Over-occlusion: what a march sees of the sky beside a sphere and a wall, against rows 9 and 11."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core


def scene_of(row: int) -> ir.Scene:
    """The closed form's scene, floor and wall cut to what matters, so that voxels are small beside it.

    A wall 16 times as long as high hides 7e-4 less of the sky, in parts, than an endless one (Howell B-4).
    """
    whole, half = ir.scenes.closed_form(row).scene, 2 if row == 9 else 8
    floor, blocker = whole.meshes
    cut = [ir.Mesh(np.clip(m.positions, -half, half), m.triangles, material=m.material) for m in (floor, blocker)]
    return ir.Scene(meshes=cut, lights=whole.lights, cameras=whole.cameras)


def occlusion_of(row: int) -> float:
    value = ir.scenes.closed_form(row).value
    return value if row == 9 else 1 - value


def gathered(scene: ir.Scene, technique: object, resolution: int = 128) -> _core.GatheredLight:
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=resolution), scene.core, None))
    pyramid = ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(), scene, voxels))
    return ir.march(technique, pyramid, ir.trace_gbuffer(scene, "view", (32, 32)), scene, seed=1)


@pytest.mark.parametrize("row", [9, 11])
def test_rays_are_occluded_as_the_closed_form_says(row: int) -> None:
    light, truth = gathered(scene_of(row), ir.TracedRays(samples=256), resolution=32), occlusion_of(row)
    noise = np.sqrt(truth * (1 - truth) / (256 * 32 * 32))  # independent rays; stratified ones have less
    assert light.occlusion.mean() == pytest.approx(truth, abs=5 * noise + 2e-3 * truth)
    assert light.sky.mean() / np.pi == pytest.approx(1 - truth, abs=5 * noise + 2e-3 * truth)


@pytest.mark.parametrize("row", [9, 11])
def test_narrower_cones_are_occluded_more_nearly_as_the_closed_form_says(row: int) -> None:
    # A cone takes what lies beside it for half in its way: its error shrinks with its aperture. A sphere that fills a quarter of
    # the view shows its whole outline; a wall only its upper edge.
    found = [float(gathered(scene_of(row), ir.DiffuseCones(cones=n)).occlusion.mean()) for n in (10, 40, 160)]
    errors = np.subtract(found, occlusion_of(row))
    assert errors[0] > errors[1] > abs(errors[2])
    assert abs(errors[1]) < (0.12 if row == 9 else 0.02)  # the default cones


@pytest.mark.parametrize("row", [9, 11])
@pytest.mark.parametrize("cls", ir.techniques("march"))
def test_what_is_open_is_sky_and_the_rest_is_occlusion(cls: type, row: int) -> None:
    technique = cls(samples=64) if cls is ir.TracedRays else cls()
    light = gathered(scene_of(row), technique)
    np.testing.assert_allclose(light.sky.mean(-1) / np.pi + light.occlusion, 1, atol=2e-3)  # the sky's radiance is 1


def test_a_balls_occlusion_is_half_as_wrong_where_steps_are_correlated() -> None:
    """Cones along the ball's side see the same part of it blocked at every step; as independent parts they add up to all."""
    ways = (ir.DiffuseCones(level_bias=-1, correlation=c) for c in (0, 1))
    independent, correlated = (gathered(scene_of(9), way).occlusion.mean() - occlusion_of(9) for way in ways)
    assert 0 < correlated < 0.6 * independent
