"""Charts for light maps: inside of the map, apart from each other, as large as the surface asks for."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest

import interreflect as ir
from interreflect.scenes import unwrap as module
from interreflect.scenes.charts_of import CHART_TRIANGLES, DENSE_TRIANGLES, PIECE_TEXELS, cut, pieces_of
from interreflect.scenes.unwrap import pack, unwrap


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
    # One scale for all, but for charts' sides that are rounded up to whole texels.
    length, drawn = (
        np.linalg.norm(np.roll(ends[charted], -1, 1) - ends[charted], axis=2).ravel() for ends in (corners, texcoord.astype(float))
    )
    assert ((drawn - np.sqrt(2)) / length).max() <= (drawn / length).min() + 1e-3
    if texels == 128:
        density = area_of(texcoord[charted].astype(float)) / triangle_areas(corners)[charted]
        assert density == pytest.approx(np.full(charted.sum(), np.median(density)), rel=0.1)
    assert area_of(texcoord[charted]).sum() > 0.4 * texels**2


def globe(rings):
    """(2 rings (rings - 1), 3, 3): a sphere's triangles by latitude and longitude."""
    down, around = np.meshgrid(np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, rings + 1), indexing="ij")
    points = np.stack((np.sin(down) * np.cos(around), np.sin(down) * np.sin(around), np.cos(down)), 2).astype(np.float32)
    points[:, -1], points[0], points[-1] = points[:, 0], points[0, 0], points[-1, 0]
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    triangles = np.concatenate([np.stack(corners, 2).reshape(-1, 3, 3) for corners in ((a, b, c), (a, c, d))])
    return triangles[np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) > 1e-9]


def readers(texcoord, steps=24):
    """How many charts' bilinear look-ups read each texel, by texel; triangles (n, 3, 2)."""
    weights = np.array([(i, j, steps - i - j) for i in range(steps + 1) for j in range(steps + 1 - i)]) / steps
    at = np.einsum("wk,nkd->nwd", weights, texcoord)
    # Look-ups between four texels' very centres weigh what rounding adds to their place.
    low, high = np.floor(at - 0.5 + 1e-4).astype(int), np.floor(at + 0.5 - 1e-4).astype(int)
    _, corner = np.unique(texcoord.reshape(-1, 2), axis=0, return_inverse=True)
    chart = np.broadcast_to(pieces_of(corner.reshape(-1, 3))[:, None], at.shape[:2])
    seen = set()
    for x in (low, high):
        for y in (low, high):
            seen |= set(zip(chart.ravel(), x[..., 0].ravel(), y[..., 1].ravel(), strict=True))
    return Counter((x, y) for _, x, y in seen)


def triangle_areas(triangles):
    return 0.5 * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1)


@pytest.mark.parametrize("texels", [24, 64])
def test_no_texel_is_read_by_two_charts(texels):
    triangles = globe(16)
    texcoord = pack(triangles, triangle_areas(triangles), texels)
    assert texcoord.min() >= 0 and texcoord.max() <= texels
    assert max(readers(texcoord).values()) == 1


def test_charts_of_pieces_with_many_triangles_are_bounded():
    triangles = globe(40)
    assert len(triangles) > DENSE_TRIANGLES
    area = triangle_areas(triangles)

    def charts(side):
        """Number of each triangle's chart, where the piece has that many texels a side."""
        return pieces_of(cut(triangles, finest=side / np.sqrt(area.sum()))[1])

    hardly_shown, shown = charts(PIECE_TEXELS**0.5 - 1), charts(PIECE_TEXELS**0.5 + 1)
    assert np.bincount(hardly_shown).max() < 2 * CHART_TRIANGLES
    assert shown.max() < hardly_shown.max()


def test_nothing_has_a_chart_where_nothing_is_asked_for_and_none_fits():
    assert unwrap(ir.scenes.cornell_box(), 128, area_share=0.0).max() == -1
    assert unwrap(ir.scenes.cornell_box(), 1).max() == -1


def test_a_packer_that_fails_is_an_error_with_its_words(monkeypatch):
    monkeypatch.setattr(module.sys, "executable", "/bin/false")
    with pytest.raises(RuntimeError, match="unwrapping for a light map failed"):
        unwrap(ir.scenes.cornell_box(), 32)
