"""Charts for light maps: inside of the map, apart from each other, as large as the surface asks for."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect as ir
from interreflect.scenes import unwrap as module
from interreflect.scenes.unwrap import unwrap


def area_of(texcoord):
    a, b = texcoord[:, 1] - texcoord[:, 0], texcoord[:, 2] - texcoord[:, 0]
    return 0.5 * np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])


@pytest.mark.parametrize("texels", [32, 128])
def test_charts_lie_in_the_map_and_are_in_proportion_to_the_surface(texels):
    scene = ir.scenes.cornell_box()
    texcoord = unwrap(scene, texels).reshape(-1, 3, 2)
    charted = texcoord[:, 0, 0] >= 0
    assert charted.any()
    assert texcoord[charted].min() >= 0 and texcoord[charted].max() <= texels
    corners = np.concatenate([np.asarray(mesh.positions, float)[np.asarray(mesh.triangles)] for mesh in scene.meshes])
    assert len(corners) == len(texcoord)
    surface = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    density = area_of(texcoord[charted].astype(float)) / surface[charted]
    assert density == pytest.approx(np.full(charted.sum(), np.median(density)), rel=0.1)
    assert area_of(texcoord[charted]).sum() > 0.2 * texels**2


def test_nothing_has_a_chart_where_nothing_is_asked_for_and_none_fits():
    assert unwrap(ir.scenes.cornell_box(), 128, area_share=0.0).max() == -1
    assert unwrap(ir.scenes.cornell_box(), 1).max() == -1


def test_a_packer_that_fails_is_an_error_with_its_words(monkeypatch):
    monkeypatch.setattr(module.sys, "executable", "/bin/false")
    with pytest.raises(RuntimeError, match="unwrapping for a light map failed"):
        unwrap(ir.scenes.cornell_box(), 32)
