"""The atrium: as fine as asked for, solid, lit by the sun where it should be."""

from __future__ import annotations

import numpy as np
import pytest
from test_builtin import is_closed, volume

import interreflect.scenes as scenes
from interreflect.scenes.builtin import atrium_parts, patterns
from interreflect.scenes.builtin.atrium_plan import structure
from interreflect.scenes.builtin.shapes import face_areas


@pytest.mark.parametrize("detail", [5_000, 8_000, 20_000, 60_000, 130_000, 300_000])
def test_the_atrium_has_the_number_of_triangles_asked_for(detail):
    scene = scenes.atrium(detail)
    assert abs(scene.triangles / detail - 1) < 0.1
    smallest = min(face_areas_of(mesh).min() for mesh in scene.meshes)
    assert smallest > 1e-7  # square metres: a third of a millimetre by as much


def face_areas_of(mesh):
    a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def test_detail_moves_nothing():
    coarse, fine = scenes.atrium(5_000), scenes.atrium(100_000)
    assert coarse.bounds == pytest.approx(fine.bounds)
    assert coarse.lights == fine.lights
    assert dict(coarse.cameras) == dict(fine.cameras)


@pytest.mark.parametrize("fineness", [0, 0.5])
def test_all_that_is_built_is_solid_and_faces_out(fineness):
    for part in structure(fineness):
        if part.material == "marble" and len(part.places) > 1:  # columns and posts stand open in what they stand on
            low, high = part.unit.positions[:, 1].min(), part.unit.positions[:, 1].max()
            ends = open_edges(part.unit)[:, :, 1]
            assert ((ends < low + 0.16) | (ends > high - 0.16)).all()
        elif part.material != "leaves":
            assert is_closed(part.unit), part.material
        assert volume(part.unit) > 0 or part.material == "leaves", part.material


def open_edges(shape):
    """(n, 2, 3) edges that only one triangle has."""
    _, vertex = np.unique(np.round(shape.positions, 6), axis=0, return_inverse=True)
    t = vertex.reshape(-1)[shape.triangles].astype(np.int64)
    edges = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    paired = np.isin(edges[:, 0] * len(vertex) + edges[:, 1], edges[:, 1] * len(vertex) + edges[:, 0])
    ends = np.concatenate([shape.triangles[:, [0, 1]], shape.triangles[:, [1, 2]], shape.triangles[:, [2, 0]]])[~paired]
    return shape.positions[ends]


def test_outer_walls_are_half_a_metre_thick():
    (walls,) = (part for part in structure(0) if part.material == "plaster")
    low, high = walls.unit.positions.min(0), walls.unit.positions.max(0)
    inside = walls.unit.positions[np.abs(walls.unit.positions[:, 0]) < high[0] - 0.01]
    assert high[0] - inside[:, 0].max() == pytest.approx(0.5)
    assert high[1] - low[1] == pytest.approx(10.75)


def test_textures_reflect_less_than_the_built_in_bound_and_repeat_without_a_seam():
    for mesh in scenes.atrium(5_000).meshes:
        pixels = mesh.material.albedo_map.pixels.astype(float)
        assert pixels.max() <= 255 * 0.906  # sRGB of 0.8
        steps = np.abs(np.diff(pixels, axis=1)).mean((0, 2))
        seam = np.abs(pixels[:, 0] - pixels[:, -1]).mean()
        assert seam <= max(4 * steps.mean(), steps.max() + 1), mesh.name


def test_encoding_is_srgb():
    linear = np.array([[[0.0, 0.002, 0.2140411]]])  # 0.214: sRGB 127.5 / 255
    assert patterns.encoded(linear)[0, 0].tolist() in ([0, 7, 127], [0, 7, 128])


def test_a_simplified_line_keeps_its_corners():
    x = np.linspace(0, 1, 101)
    line = np.stack([x, np.abs(x - 0.3)], 1)
    assert atrium_parts.simplified(line, 3)[1] == pytest.approx((0.3, 0))


def test_parts_have_more_sides_when_asked():
    for part in (atrium_parts.column(3, 0.25, 8, 10), atrium_parts.urn(8, 6), atrium_parts.fountain(8, 6)):
        assert face_areas(part).min() > 0
    assert len(atrium_parts.baluster(0.8, 16, 8).triangles) > len(atrium_parts.baluster(0.8, 4, 8).triangles)


def sunlit(scene, points):
    """Whether the sun reaches points: a triangle test without any hierarchy."""
    direction = -np.array(scene.lights[0].direction)
    lit = np.ones(len(points), bool)
    for mesh in scene.meshes:
        a, b, c = (mesh.positions[mesh.triangles[:, k]].astype(float) for k in range(3))
        e1, e2 = b - a, c - a
        p = np.cross(direction, e2)
        det = np.sum(e1 * p, 1)
        with np.errstate(divide="ignore", invalid="ignore"):
            for k, point in enumerate(points):
                s = point - a
                u = np.sum(s * p, 1) / det
                q = np.cross(s, e1)
                v, t = q @ direction / det, np.sum(e2 * q, 1) / det
                lit[k] &= not ((u > 0) & (v > 0) & (u + v < 1) & (t > 1e-4)).any()
    return lit


def test_the_sun_reaches_part_of_the_floor_and_of_the_curtains_and_nothing_behind_the_walls():
    scene = scenes.atrium(5_000)
    rng = np.random.default_rng(0)
    floor = np.stack([rng.uniform(-7, 7, 60), np.full(60, 0.001), rng.uniform(-2.6, 2.6, 60)], 1)
    assert 0.2 < sunlit(scene, floor).mean() < 0.8
    hung = np.concatenate([m.positions[m.positions[:, 2] < -3] for m in scene.meshes if m.name.endswith("cloth")])
    behind = hung[rng.choice(len(hung), 60)] + (0, 0, 0.02)
    assert sunlit(scene, behind).mean() > 0.15
    aisle = np.stack([rng.uniform(-10, 10, 60), rng.uniform(0.5, 8.5, 60), np.full(60, 5.98)], 1)  # at the wall in the shade
    assert sunlit(scene, aisle).mean() < 0.1
