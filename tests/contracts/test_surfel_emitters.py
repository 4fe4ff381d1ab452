"""Emitters through links: their direct light from surfels that glow, counted once, and other with every frame's emission."""

from __future__ import annotations

import numpy as np
import pytest
from voxel_scenes import box

import interreflect as ir
from interreflect.scenes.compile import _hierarchies

SIZE = (48, 36)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=1024), place_caches=ir.CacheGrid(nx=4, ny=4, nz=4), link=ir.ShLinks(links=128), emitters="links",
)  # fmt: skip


def glowing_floor(image, albedo=0.5, strength=1.0):
    """A closed box whose floor emits through a map; image: (h, w) of it."""
    corners = np.array([(-1, -1, 1), (1, -1, 1), (1, -1, -1), (-1, -1, -1)], float)
    texture = ir.Texture(np.repeat(np.asarray(image, np.float32)[..., None], 3, axis=2))
    glow = ir.Material(name="screen", albedo=(albedo,) * 3, emission=(strength,) * 3, emission_map=texture)
    texcoords = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    screen = ir.Mesh(corners, np.array([(0, 1, 2), (0, 2, 3)]), material=glow, texcoords=texcoords)
    room = box((-1, -1.001, -1), inward=True, material=ir.Material(name="walls", albedo=(albedo,) * 3))
    view = ir.Camera(position=(0, 0.2, 0.95), target=(0, 0, -1), fov_x=90)
    return ir.Scene(meshes=[room, screen], cameras={"view": view})


def halves(left, right):
    return np.repeat([[left, right]], 8, axis=1).reshape(1, 16).repeat(8, axis=0)


def test_emitters_through_links_bring_the_light_of_paths_direct_and_indirect():
    scene = glowing_floor(halves(1, 0))
    truth = ir.methods.PathTracing(spp=512, bounces=2).render(scene, size=SIZE)
    made = METHOD.replace(place_caches=ir.PixelCaches(), bounces=2).render(scene, size=SIZE)
    walls = np.asarray(ir.trace_gbuffer(scene, None, SIZE).position)[..., 1] > -0.99
    for light in ("direct", "indirect"):
        one, other = (np.asarray(getattr(frame, light))[walls].mean() for frame in (made, truth))
        assert one == pytest.approx(other, rel=0.015), light  # surfels across the border of dark and bright; measured .994, .995


def test_an_emitter_in_black_walls_lights_nothing_twice():
    scene = glowing_floor(np.ones((2, 2)), albedo=0.0)
    frame = METHOD.replace(bounces=3).render(scene, size=SIZE)
    assert frame.indirect.max() == 0
    assert (frame.direct == np.asarray(ir.trace_gbuffer(scene, None, SIZE).emission)).all()


def test_what_a_screen_shows_is_an_argument_of_the_frame():
    prepared = METHOD.prepare(glowing_floor(halves(1, 0)))
    for image in (halves(0, 1), halves(0.2, 0.4), np.eye(4)):
        frame = prepared.render(size=SIZE, scene=glowing_floor(image))
        assert (frame.image == METHOD.render(glowing_floor(image), size=SIZE).image).all()


def test_other_emission_shares_the_hierarchy():
    scene = glowing_floor(halves(1, 0))
    _ = scene.core
    known = len(_hierarchies)
    other = scene.replace(materials={"screen": {"emission": (0, 0, 0)}})
    _ = other.core
    assert len(_hierarchies) == known and other.core_milliseconds <= scene.core_milliseconds
    # Now all materials but the screen's map are alike, and one number would do for both: nothing is shared.
    plain = scene.replace(materials={"screen": {"emission": (0, 0, 0), "emission_map": None}})
    assert ir.trace_gbuffer(plain, None, SIZE).albedo.shape == (*SIZE[::-1], 3)
    assert plain.surface_hash == scene.surface_hash != scene.replace(materials={"walls": {"albedo": (0.1, 0.1, 0.1)}}).surface_hash


def test_light_from_links_is_linear_in_emission():
    prepared = METHOD.prepare(glowing_floor(halves(1, 0)))
    once, twice = (prepared.render(size=SIZE, scene=glowing_floor(halves(1, 0), strength=s)) for s in (1.0, 2.0))
    assert twice.image == pytest.approx(2 * np.asarray(once.image), rel=1e-4)


def test_another_albedo_needs_another_preparation():
    with pytest.raises(ValueError, match="not another one"):
        METHOD.prepare(glowing_floor(halves(1, 0))).render(size=SIZE, scene=glowing_floor(halves(1, 0), albedo=0.4))
    other = ir.methods.VoxelConeTracing().prepare(glowing_floor(halves(1, 0)))
    with pytest.raises(ValueError, match="not another one"):
        other.render(size=SIZE, scene=glowing_floor(halves(0, 1)))
