"""The built-in scenes: what their geometry must satisfy, whatever the knobs."""

from __future__ import annotations

import numpy as np
import pytest

import interreflect.scenes as scenes
from interreflect.scenes.builtin import shapes

VARIANTS = [
    ("atrium", {"detail": 5_000}),
    ("cornell_box", {}), ("cornell_box", {"light": "point"}), ("cornell_box", {"light": "spot", "box": "glossy"}),
    ("furnace", {}), ("furnace", {"shape": "sphere", "albedo": 0.8}),
    ("integrating_sphere", {}), ("integrating_sphere", {"light": "point", "radius": 3}),
    ("corner", {}), ("corner", {"light": "spot"}), ("facing_squares", {"distance": 2}), ("disk_above_point", {"offset": 1}),
    ("thin_wall", {}), ("thin_wall", {"thickness": 0.1, "rotation": 30, "offset": 0.01}),
    ("corner", {"light": "spot", "aim": 0.1, "cap": 4, "fields": 8}), ("thin_wall", {"ball": 0.04}),
    ("ball_on_floor", {}), ("ball_on_floor", {"radius": 0.02}), ("blade", {}), ("blade", {"height": 0.01}),
    ("blocked_sky", {}), ("blocked_sky", {"blocker": "wall", "distance": 0.02}), ("lone_ball", {}), ("lone_ball", {"radius": 0.02}),
    ("glossy_receiver", {}), ("glossy_receiver", {"spot": 2, "exponent": 400}), ("opposed_lights", {}), ("penumbra", {"height": 0.05}),
    ("dark_room", {}), ("dark_room", {"thickness": 0.01, "rotation": 30, "offset": 0.005}), ("opaque_layer", {"cells": 32}),
    ("sunlit_floor", {}), ("sunlit_floor", {"tilt": 45}),
    ("sunk_box", {}), ("sunk_box", {"depth": 0.1, "height": 0.05}),
    ("corridors", {}), ("corridors", {"thickness": 0.05, "length": 20}),
    ("grille", {}), ("grille", {"bars": 60, "width": 0.004}),
    ("glossy_plates", {}), ("glossy_plates", {"lobe": "phong"}),
    ("textured_light_box", {}), ("textured_light_box", {"grating": 8}),
    ("foliage", {"length": 0.2}), ("foliage", {"length": 0.1, "seed": 7}), ("wires", {}), ("wires", {"width": 0.004, "count": 9}),
    ("depth_edge", {}), ("depth_edge", {"gap": 0.8}), ("ball_in_sky", {}), ("ball_in_sky", {"radius": 0.02}),
    ("corner", {"light": "sun"}), ("lit_patch", {}), *(("lit_patch", {"blocker": kind}) for kind in ("none", "edge", "edges", "slit")),
]  # fmt: skip


def shape_of(mesh):
    return shapes.Shape(mesh.positions.astype(np.float64), mesh.triangles)


def volume(shape):
    a, b, c = (shape.positions[shape.triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


def is_closed(shape):
    """Every edge is used once each way, after vertices at equal places are joined."""
    _, vertex = np.unique(np.round(shape.positions, 6), axis=0, return_inverse=True)
    t = vertex.reshape(-1)[shape.triangles].astype(np.int64)
    edges = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    forward, backward = (np.sort(e[:, 0] * len(shape.positions) + e[:, 1]) for e in (edges, edges[:, ::-1]))
    return np.array_equal(forward, backward)


@pytest.mark.parametrize(("name", "knobs"), VARIANTS)
def test_geometry_is_sound(name, knobs):
    scene = getattr(scenes, name)(**knobs)
    assert scene.cameras
    assert not scene.warnings
    for mesh in scene.meshes:
        areas = shapes.face_areas(shape_of(mesh))
        assert areas.min() > 1e-10 * areas.max(), mesh.name
        assert np.array_equal(np.unique(mesh.triangles), np.arange(len(mesh.positions))), mesh.name
        if mesh.normals is not None:
            assert np.linalg.norm(mesh.normals, axis=1) == pytest.approx(1, abs=1e-5)
        material = mesh.material
        assert material.name
        if name != "furnace" and material.albedo_map is None:
            assert max(np.add(material.albedo, material.specular)) <= 0.8
        assert material.albedo_map is None or mesh.texcoords is not None


@pytest.mark.parametrize(("name", "knobs"), VARIANTS)
def test_the_same_knobs_give_the_same_scene_and_others_another(name, knobs):
    make = getattr(scenes, name)
    assert make(**knobs).hash == make(**knobs).hash
    assert make(**knobs).name == make(**knobs).name
    if knobs:
        assert make(**knobs).hash != make().hash
        assert make(**knobs).name != make().name


@pytest.mark.parametrize("name", ["furnace", "integrating_sphere", "thin_wall", "dark_room", "corridors"])
def test_rooms_are_closed(name):
    assert all(is_closed(shape_of(mesh)) for mesh in getattr(scenes, name)().meshes)


def test_bodies_are_closed_and_face_out():
    for mesh in scenes.textured_light_box(grating=5).meshes:
        if mesh.body != "world" or mesh.name == "grating":
            assert is_closed(shape_of(mesh))
            assert volume(shape_of(mesh)) > 0
        if mesh.normals is not None:
            a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
            assert (np.sum(np.cross(b - a, c - a) * mesh.normals[mesh.triangles[:, 0]], 1) > 0).all()


@pytest.mark.parametrize("shape", ["cube", "sphere"])
def test_furnaces_face_in(shape):
    (mesh,) = scenes.furnace(shape).meshes
    assert volume(shape_of(mesh)) == pytest.approx({"cube": -8, "sphere": -4 / 3 * np.pi}[shape], rel=3e-4)  # facets of 96 rings


def test_a_sphere_has_the_true_area():
    assert shapes.face_areas(shapes.sphere(2, segments=12)).sum() == pytest.approx(16 * np.pi)
    assert shapes.face_areas(shapes.disk(2, segments=12)).sum() == pytest.approx(4 * np.pi)


def test_solids_have_their_volume_and_face_out():
    solids = {
        "box": (shapes.box((0, 0, 0), (1, 2, 3)), 6),
        "ring": (shapes.ring(2, 1, [(0, 0), (1, 0), (1, 0.5), (0, 0.5)]), 0.5 * (6 * 4 - 4 * 2)),
        "arcade": (shapes.arcade(6, 2, 1.2, 1.5, 0.5, 200), 0.5 * (6 * 1.5 - np.pi * 1.2**2)),
        "tube": (shapes.tube((0, 0, 0), (1, 2, 3), 0.1, 200), np.pi * 0.1**2 * np.sqrt(14)),
    }
    for name, (shape, expected) in solids.items():
        assert is_closed(shape), name
        assert volume(shape) == pytest.approx(expected, rel=3e-4), name  # polygons of 200 corners


@pytest.mark.parametrize("knobs", [{}, {"thickness": 0.2, "rotation": 45, "offset": 0.1}, {"thickness": 1e-3, "offset": -0.1}])
def test_the_longest_side_of_a_thin_wall_scene_is_one(knobs):
    low, high = scenes.thin_wall(**knobs).bounds
    assert high - low == pytest.approx((1, 0.38, 1), abs=1e-6)


@pytest.mark.parametrize("thickness", [0.001, 0.05])
def test_rooms_of_a_thin_wall_are_that_far_apart(thickness):
    positions = scenes.thin_wall(thickness, offset=0.03).meshes[0].positions
    beside = np.unique(positions[np.abs(positions[:, 0] - 0.03) < 0.1][:, 0])
    assert beside == pytest.approx((0.03 - thickness / 2, 0.03 + thickness / 2), abs=1e-7)


def test_every_light_of_the_cornell_box_emits_the_same_flux():
    area = scenes.cornell_box()
    (lamp,) = (m for m in area.meshes if any(m.material.emission))
    flux = np.pi * shapes.face_areas(shape_of(lamp)).sum() * np.array(lamp.material.emission)
    (point,) = scenes.cornell_box("point").lights
    assert np.multiply(4 * np.pi, point.intensity) == pytest.approx(flux, rel=1e-5)
    (spot,) = scenes.cornell_box("spot").lights
    cosine = 1 - (np.arange(100_000) + 0.5) / 100_000
    inner, outer = np.cos(np.radians((spot.inner, spot.outer)))
    t = np.clip((cosine - outer) / (inner - outer), 0, 1)
    assert 2 * np.pi * np.mean(t * t * (3 - 2 * t)) * np.array(spot.intensity) == pytest.approx(flux, rel=1e-4)


def test_the_ceiling_shows_four_asterisks_and_a_ring():
    from skimage.measure import label

    from interreflect.scenes.builtin.textured_light_box import emission_pattern

    lit = emission_pattern() > 0.5
    assert label(lit, connectivity=1).max() == 5
    assert label(~lit, connectivity=1).max() == 2  # the ring's inside and all the rest


WRONG = [
    ("atrium", {"detail": 4_999}, r"atrium.detail must be a whole number in \[5000, 300000\], got 4999"),
    ("cornell_box", {"light": "sun"}, "cornell_box.light must be one of 'area', 'point', 'spot', got 'sun'"),
    ("cornell_box", {"box": "gold"}, "cornell_box.box"),
    ("furnace", {"albedo": 1.5}, r"furnace.albedo must lie in \[0, 0.999\], got 1.5"),
    ("furnace", {"shape": "cone"}, "furnace.shape"),
    ("integrating_sphere", {"radius": 0}, "integrating_sphere.radius must be a finite number above 0, got 0"),
    ("integrating_sphere", {"cap": 90}, "integrating_sphere.cap"),
    ("corner", {"light": "sky"}, "corner.light"),
    ("facing_squares", {"distance": float("nan")}, "facing_squares.distance"),
    ("disk_above_point", {"radius": -1}, "disk_above_point.radius"),
    ("thin_wall", {"thickness": 0}, r"thin_wall.thickness must lie in \(0, 0.2\], got 0"),
    ("thin_wall", {"rotation": 200}, "thin_wall.rotation"),
    ("corridors", {"length": 3}, "corridors.length"),
    ("grille", {"bars": 2.5}, r"grille.bars must be a whole number in \[2, 200\], got 2.5"),
    ("grille", {"bars": 100, "width": 0.05}, "grille.width"),
    ("foliage", {"length": 0.005}, r"foliage.length must lie in \[0.01, 0.4\], got 0.005"),
    ("wires", {"count": 0}, r"wires.count must be a whole number in \[1, 1000\], got 0"),
    ("depth_edge", {"gap": 4}, "depth_edge.gap"),
    ("ball_in_sky", {"radius": 0}, "ball_in_sky.radius"),
    ("glossy_plates", {"specular": 1}, "glossy_plates.specular"),
    ("textured_light_box", {"grating": -1}, "textured_light_box.grating"),
]


@pytest.mark.parametrize(("name", "knobs", "message"), WRONG)
def test_knobs_out_of_range_are_refused_by_name_bound_and_value(name, knobs, message):
    with pytest.raises(ValueError, match=message):
        getattr(scenes, name)(**knobs)


def test_every_knob_of_every_scene_is_described_and_told_in_the_docstring():
    import inspect

    from interreflect.scenes.builtin.knobs import knobs_of

    for name in set(dir(scenes)) - {"closed_form"}:
        make = getattr(scenes, name)
        described = knobs_of(make)
        assert list(described) == list(inspect.signature(make).parameters), name
        for knob, about in described.items():
            assert f"{knob}: {about.doc}; {about.range}" in make.__doc__


def test_an_unknown_knob_is_a_type_error_with_the_nearest_name():
    with pytest.raises(TypeError, match="thin_wall has no knob 'thicknes'; did you mean 'thickness'"):
        scenes.thin_wall(thicknes=0.1)


def test_the_name_of_a_scene_tells_its_knobs():
    assert scenes.thin_wall(0.1, offset=0.01).name == "thin_wall(thickness=0.1, rotation=0, offset=0.01, ball=0)"
    assert scenes.cornell_box(light="spot").name == "cornell_box(light='spot', box='diffuse')"
