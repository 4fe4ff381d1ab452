"""Whole methods on scenes that are scaled, moved and turned: lights, cameras and pictures go with them."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from experiments.shared.placed import placed, turned

import interreflect as ir

sys.path.insert(0, str(Path(__file__).parents[1] / "statistics"))

from welch import compare

SIZE = (64, 48)
# Every pixel has all cones: interleaved ones see another part of them at the picture's border. A power of two: else the uppermost
# coarse texels are partly outside, the lowermost ones are not, and a turn of the scene by 90 degrees moves the mean by a per cent.
CONES = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=64), share=ir.EveryPixel(), shadow=ir.TracedShadows(samples=16))
# Octants change abruptly where a cone's direction crosses a plane of the grid: on walls along the grid some cones lie in such planes,
# and rounding, or the turn of a pixel's frame, puts them on either side. That moves single pixels, and the mean by a per cent or two.
SIDES = {
    "one side": (CONES.replace({"prefilter": ir.SurfaceCoverage(), "light_voxels": ir.TracedLighting()}), 1),
    "octants": (CONES, 2),
}
ASIDE = ir.Camera(position=(0.13, 1.07, 3.7), target=(0, 1, 0), fov_x=39)  # beside the plane of symmetry: no edge runs through pixels


@pytest.fixture(scope="module")
def room() -> ir.Scene:
    """A Cornell box with a glossy block, its area light, and a point and a spot light more."""
    box = ir.scenes.cornell_box(box="glossy")
    more = [
        ir.PointLight(position=(0.5, 1.4, 0.6), intensity=(0.6, 0.4, 0.2)),
        ir.SpotLight(position=(-0.6, 1.7, 0.5), direction=(0.3, -1, -0.4), intensity=(2, 2, 3), inner=15, outer=30),
    ]
    return box.replace(lights=more, cameras={"view": ASIDE})


def differing(a: np.ndarray, b: np.ndarray, by: float) -> float:
    """Share of the pixels that differ by more than `by` of their light."""
    return float((np.abs(a - b).max(-1) > by * (a.max(-1) + a.mean())).mean())


@pytest.mark.parametrize("sides", SIDES)
@pytest.mark.parametrize("change", [{"scale": 1e-3}, {"scale": 1e3}, {"shift": (200, -200, 200)}], ids=str)
def test_voxel_cone_tracing_makes_the_same_picture_of_a_scene_of_another_size_or_place(
    room: ir.Scene, change: dict[str, Any], sides: str
) -> None:
    cones, free = SIDES[sides]
    before, after = (cones.render(scene, size=SIZE) for scene in (room, placed(room, **change)))
    assert differing(before.direct, after.direct, 1e-2) < 0.005  # edges of shadows within rounding of a pixel's centre
    # Rounding lights a voxel at a shadow's edge or not, which the pixels near it see.
    assert differing(before.indirect, after.indirect, 5e-2) < 0.01 * free
    assert after.indirect.mean() == pytest.approx(before.indirect.mean(), rel=0.01)
    assert after.direct.mean() == pytest.approx(before.direct.mean(), rel=1e-3)


@pytest.mark.parametrize("sides", SIDES)
@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 0, 0), (0, 0, 1)], ids=str)
def test_voxel_cone_tracing_turns_with_a_scene_that_turns_with_the_grid(room: ir.Scene, axis: tuple[int, int, int], sides: str) -> None:
    cones, free = SIDES[sides]
    before, after = (cones.render(scene, size=SIZE) for scene in (room, placed(room, turn=turned(90, axis))))
    # Voxels fall alike, but look at other points of the lamp; the cones of a pixel are turned about its normal.
    assert after.indirect.mean() == pytest.approx(before.indirect.mean(), rel=0.005 * free)
    assert np.abs(after.indirect - before.indirect).mean() < 0.04 * free * before.indirect.mean()
    assert after.direct.mean() == pytest.approx(before.direct.mean(), rel=0.01)  # other points on the lamp


def test_voxel_cone_tracing_of_a_scene_turned_against_the_grid_has_about_the_same_light(room: ir.Scene) -> None:
    before, after = (CONES.render(scene, size=SIZE) for scene in (room, placed(room, turn=turned(30, (1, 2, 3)))))
    # Slanted walls fill more voxels, and voxels grow with the larger box about the scene.
    assert after.indirect.mean() == pytest.approx(before.indirect.mean(), rel=0.15)


@pytest.mark.parametrize("bounces", [0, 2])
def test_path_tracing_finds_the_same_light_in_a_turned_and_moved_scene(room: ir.Scene, bounces: int) -> None:
    there = placed(room, scale=3, turn=turned(50, (1, 2, 3)), shift=(7, -11, 13))
    tracers = [ir.methods.PathTracing(spp=32, bounces=bounces).prepare(scene) for scene in (room, there)]
    images = [np.stack([tracer.render(size=SIZE, seed=seed).image for seed in range(6)]) for tracer in tracers]
    found = compare(*images)
    # A true null has 1e-3 of its 144 tests below 1e-3: four are one in 20,000. Then 5 standard errors of the mean.
    assert (found.p_values < 1e-3).sum() < 4
    assert abs(found.mean_difference) < 5 * found.mean_error + 2e-4
