"""What the camera sees must not depend on where a scene stands and how large it is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from experiments.shared.placed import placed

import interreflect as ir

SIZE = (160, 120)
# The first camera stands beside the plane of symmetry, lest edges and diagonals run through pixel centres.
ASIDE = ir.Camera(position=(0.13, 1.07, 3.7), target=(0, 1, 0), fov_x=39)
SCENES = {
    "cornell_box": lambda: ir.scenes.cornell_box().replace(cameras={"view": ASIDE}),
    "atrium": ir.scenes.atrium,
}


def seen(scene: ir.Scene) -> dict[str, np.ndarray]:
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    names = ("position", "normal", "geometric_normal", "albedo", "specular", "emission", "alpha", "depth", "triangle", "body")
    return {name: np.array(getattr(gbuffer, name)) for name in names}


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("change", [{"scale": 1e-3}, {"scale": 1e3}], ids=str)
def test_a_scene_of_another_size_looks_the_same_but_for_its_lengths(name: str, change: dict[str, Any]) -> None:
    scene, scale = SCENES[name](), change["scale"]
    before, after = seen(scene), seen(placed(scene, **change))
    hit = np.isfinite(before["depth"])
    assert hit.mean() > 0.5
    # Where a pixel's centre falls on the edge of two triangles within rounding, either is right.
    same = before["triangle"] == after["triangle"]
    assert same.mean() > 0.999
    both = hit & same
    extent = float(np.ptp(scene.bounds, axis=0).max())
    np.testing.assert_allclose(after["depth"][both] / scale, before["depth"][both], rtol=1e-5)
    np.testing.assert_allclose(after["position"][both] / scale, before["position"][both], atol=1e-5 * extent)
    for unit in ("normal", "geometric_normal"):
        np.testing.assert_allclose(after[unit][both], before[unit][both], atol=1e-4)
    for exact in ("specular", "emission", "alpha", "body"):
        assert np.array_equal(after[exact][both], before[exact][both])
    # Texels are 1/256 steps: a footprint that differs by rounding weighs them otherwise by as little.
    np.testing.assert_allclose(after["albedo"][both], before["albedo"][both], atol=1e-3)
    assert np.array_equal(after["emission"][~hit], before["emission"][~hit])


@pytest.mark.parametrize("uses", [1, 2])
def test_shading_normals_stay_across_a_surface_that_is_stretched(uses: int) -> None:
    # Normal and plane of the triangle agree; stretched twofold along x, both are as (1 / 2, 1, 0). Used twice, it is an instance.
    corners = np.array([[-1, 1, 0], [1, -1, 0], [0, 0, -2]], np.float32)
    mesh = ir.Mesh(corners, np.array([[0, 1, 2]], np.uint32), normals=np.array([[1, 1, 0]] * 3, np.float32) / np.float32(np.sqrt(2)))
    stretched = np.diag([2.0, 1.0, 1.0, 1.0])
    away = stretched.copy()
    away[2, 3] = -50.0
    meshes = [mesh.replace(transform=matrix) for matrix in (stretched, away)[:uses]]
    view = ir.Camera(position=(1, 2, -0.7), target=(0, 0, -0.7), fov_x=40)
    scene = ir.Scene(meshes=meshes, lights=[], cameras={"view": view})
    gbuffer = ir.trace_gbuffer(scene, size=(24, 24))
    hit = np.isfinite(gbuffer.depth)
    assert hit.mean() > 0.2
    expected = np.array([0.5, 1, 0]) / np.sqrt(1.25)
    np.testing.assert_allclose(gbuffer.normal[hit], np.broadcast_to(expected, (hit.sum(), 3)), atol=1e-5)
    np.testing.assert_allclose(gbuffer.geometric_normal[hit], np.broadcast_to(expected, (hit.sum(), 3)), atol=1e-5)
