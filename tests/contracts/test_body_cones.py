"""Bodies that move block the light of links and send their own: cones through their voxels, against traced light."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from voxel_scenes import box

import interreflect as ir
from interreflect import _core, stages
from interreflect.scenes.builtin.shapes import sphere

SIZE = (48, 36)
METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=1024), place_caches=ir.LightMap(texels=24, grid=ir.CacheGrid(nx=8, ny=8, nz=8)),
    link=ir.ShLinks(links=128, near_rays=128), shadow_links=ir.BodyCones(),
)  # fmt: skip

FEW = METHOD.replace({"place_surfels.surfels": 300, "place_caches": ir.CacheGrid(nx=4, ny=4, nz=4), "link.near_rays": 32})


def room(albedo=0.0, at=(0.0, -0.4, 0.0), body="cube", **shape):
    """A cube that hangs in a room."""
    pose = np.eye(4)
    pose[:3, 3] = at
    cube = box((-0.3,) * 3, (0.3,) * 3, body=body, material=ir.Material(albedo=(albedo,) * 3), **shape)
    walls = box(inward=True, material=ir.Material(albedo=(0.7,) * 3))
    lamp = ir.PointLight(position=(-0.7, 0.7, 0), intensity=(1, 1, 1))
    view = ir.Camera(position=(0, 0.2, 0.98), target=(0, -0.4, -1), fov_x=90)
    bodies = {"cube": pose} if body == "cube" else {}
    return ir.Scene(meshes=[cube, walls], lights=[lamp], bodies=bodies, cameras={"view": view})


@cache
def truth(albedo):
    return np.asarray(ir.reference(room(albedo), "view", size=SIZE, bounces=1, noise=3e-3, max_spp=128).indirect)


@cache
def drawn(albedo):
    return rendered(albedo)


def rendered(albedo, **changes):
    return np.asarray(METHOD.replace(changes).render(room(albedo), size=SIZE).indirect)


def coefficients(caches):
    return np.float32(caches.coefficients) * np.asarray(caches.unit)[:, None]


def still_pixels():
    return np.asarray(ir.trace_gbuffer(room(), room().cameras["view"], SIZE).body).reshape(SIZE[::-1]) == 0


@pytest.mark.parametrize("link", [
    ir.ShLinks(links=128, near_rays=128), ir.RuntimeProjection(links=128, near_rays=128),
    ir.FluxLinks(links=96, candidates=128, near_rays=128),
])  # fmt: skip
def test_a_black_body_takes_the_light_that_it_blocks(link):
    unblocked, blocked = (ir.metrics.relmse(rendered(0.0, link=link, shadow_links=way), truth(0.0)) for way in (None, ir.BodyCones()))
    assert blocked < 0.15 * unblocked  # measured: .019 and .22


def test_a_white_body_sends_light_to_the_walls():
    """What walls gain by the body's own light, over what traced paths say."""
    still = still_pixels()
    gained = (drawn(0.9) - drawn(0.0))[still].sum() / (truth(0.9) - truth(0.0))[still].sum()
    assert gained == pytest.approx(1, abs=0.2)  # measured 1.05: cones are round, links are not
    assert ir.metrics.relmse(drawn(0.9), truth(0.9)) < 0.02


def voxels_of(scene, body, resolution):
    """Lit and filtered, in a world two units wide."""
    domain = stages.body_domain(scene, body, 2 / resolution)
    moved = stages.move_voxels(stages.voxelize(ir.SurfaceSampling(), scene, domain, body=body), scene, body)
    return [stages.prefilter(ir.OctantCoverage(), stages.light_voxels(ir.TracedLighting(both_sides=True), scene, moved))]


def test_caches_lose_what_rays_that_meet_the_body_do_not_bring():
    scene, empty = room(0.0), room(at=(0, 9, 0))
    made = METHOD.replace(place_caches=ir.CacheGrid(nx=4, ny=4, nz=4)).prepare(scene)
    surfels, sites, links = made.state["surfels"], made.state["sites"], made.state["links"]
    sent = stages.pull(surfels, np.asarray(ir.shadow(ir.TracedShadows(), scene, made.state["pixels"]).radiance))
    with_body, without = (
        coefficients(stages.light_caches(ir.AllSurfels(samples=0), None, sites, surfels, sent, one)) for one in (scene, empty)
    )
    lit = stages.light_caches(METHOD.link, links, sites, surfels, sent, scene)
    before = coefficients(lit)
    _core.shadow_links(ir.BodyCones(), lit, links, sent, sites, surfels, voxels_of(scene, "cube", 64), scene.core, False)
    outside = (np.abs(np.asarray(sites.position) - (0, -0.4, 0)) > 0.35).any(1)  # a cache in the body keeps its light
    lost, truly = (before - coefficients(lit))[outside], (without - with_body)[outside]
    assert np.linalg.norm(lost - truly) < 0.5 * np.linalg.norm(truly), np.linalg.norm(lost - truly) / np.linalg.norm(truly)


class EvenLight:
    """A cache in the middle of a room that is equally bright everywhere, with a body in it."""

    def __init__(self, positions, triangles, at=(0, 0, 0)):
        body = ir.Mesh(np.float32(positions), np.uint32(triangles), body="body", material=ir.Material(albedo=(0,) * 3))
        walls = box(inward=True)
        pose = np.eye(4)
        pose[:3, 3] = at
        self.scene, self.empty = ir.Scene(meshes=[body, walls], bodies={"body": pose}), ir.Scene(meshes=[walls])
        placed = stages.place_surfels(ir.HaltonSurfels(surfels=2048), self.empty)
        self.surfels = stages.cluster_surfels(ir.Agglomerative(), placed)
        self.sites = stages.place_caches(ir.CacheGrid(nx=1, ny=1, nz=1), self.empty)
        self.by = ir.ShLinks(links=512)
        self.links = stages.link(self.by, self.sites, self.surfels, self.empty)
        self.even = stages.pull(self.surfels, np.ones((len(self.surfels), 3), np.float32))

    def coefficients(self, technique=None):
        """Of the cache's red; without the body's shadow where there is no technique."""
        caches = stages.light_caches(self.by, self.links, self.sites, self.surfels, self.even, self.empty)
        if technique is not None:
            voxels = voxels_of(self.scene, "body", 64)
            given = (caches, self.links, self.even, self.sites, self.surfels, voxels, self.scene.core)
            _core.shadow_links(technique, *given)
        return coefficients(caches)[0]


def test_a_ball_blocks_the_closed_forms_share():
    """Closed form 9: a black ball of r = .25 at h = .5 takes (r / h)^2 of the irradiance of even light; its voxels make it wider by at
    most one and a half of them."""
    shape = sphere(0.25, segments=48)
    light = EvenLight(shape.positions, shape.triangles, at=(0, 0, 0.5))
    # Along z: the clamped cosine's bands (closed form 16), of the coefficients with m = 0.
    of_bands = np.pi * np.array([1, 2 / 3, 1 / 4]) * np.sqrt((2 * np.arange(3) + 1) / (4 * np.pi))
    before, after = (float(of_bands @ light.coefficients(way)[[0, 2, 6]]) for way in (None, ir.BodyCones()))
    assert before == pytest.approx(np.pi, rel=0.01)
    assert (0.25 / 0.5) ** 2 < 1 - after / before < ((0.25 + 1.5 * 2 / 64) / 0.5) ** 2  # measured .318


@pytest.mark.parametrize("density", [1.0, 2.0, 4.0])
def test_a_shell_lets_through_what_its_filtered_layer_does(density):
    """Between voxels opacity falls off linearly, 1 - |t|, so a ray straight through a layer one voxel thick meets an optical depth
    of -integral of ln |t| from -1 to 1 = 2 voxels, and slanted ones more: at most exp(-2 density) of the light comes through."""
    shape = sphere(0.4, segments=48)
    light = EvenLight(shape.positions, np.asarray(shape.triangles)[:, ::-1])  # seen from within
    open_ = light.coefficients(ir.BodyCones(density=density))[0] / light.coefficients()[0]
    assert open_ < np.exp(-2 * density) + 0.002  # half floats
    if density == 1:
        assert open_ > 0.03  # so that whoever closes the layers changes this text


def test_a_moved_body_is_the_bodys_frame_and_takes_no_precomputation():
    prepared = FEW.prepare(room())
    moved = room(at=(0.3, -0.5, 0.1))
    frame = prepared.render(size=SIZE, scene=moved)
    assert (frame.image == FEW.render(moved, size=SIZE).image).all()
    assert frame.profile.stages["shadow_links"].counts["cones"] > 0
    assert (frame.indirect != prepared.render(size=SIZE).indirect).any()


def test_a_scene_without_bodies_has_the_same_bits():
    still = room(body="world")
    assert (FEW.render(still, size=SIZE).image == FEW.replace(shadow_links=None).render(still, size=SIZE).image).all()


def test_light_is_finite_whatever_else_the_method_does():
    for changes in ({"bounces": 3}, {"bounces": None}, {"emitters": "links"}, {"lit_caches": "read"}, {"evaluate.chrominance_bands": 2},
                    {"evaluate.window": "hanning"}, {"link.pull": "radiosity"}, {"shadow_links.resolution": 8},
                    {"patch_light": "shared exponent"}):  # fmt: skip
        frame = FEW.replace(changes).render(room(0.9), size=(24, 18))
        assert np.isfinite(frame.image).all() and frame.indirect.max() > 0, changes


@pytest.mark.parametrize(("changes", "message"), [
    ({"link": ir.AllSurfels()}, "does not go with AllSurfels, whose rays meet bodies"),
    ({"place_caches": ir.PixelCaches()}, "does not go with PixelCaches"),
    ({"evaluate": ir.DirectLinks()}, "does not go with DirectLinks"),
    ({"link": ir.ShLinks(bands=1)}, "links of one band do not tell their direction"),
])  # fmt: skip
def test_what_cannot_be_is_a_value_error(changes, message):
    with pytest.raises(ValueError, match=message):
        METHOD.replace(changes)


def test_products_that_do_not_belong_together_are_value_errors():
    scene = room()
    made, other = FEW.prepare(scene), FEW.replace({"place_surfels.surfels": 100}).prepare(scene)
    state = made.state
    sent = stages.pull(state["surfels"], np.ones((len(state["surfels"]), 3), np.float32))
    caches = stages.light_caches(FEW.link, state["links"], state["sites"], state["surfels"], sent, scene)
    made.render(size=(8, 6))
    lit = stages.light_voxels(ir.TracedLighting(), scene, stages.move_voxels(state["bodies"]["cube"], scene, "cube"))
    pyramids = [stages.prefilter(ir.OctantCoverage(), lit)]
    with pytest.raises(ValueError, match="do not belong together"):
        _core.shadow_links(ir.BodyCones(), caches, state["links"], sent, state["sites"], other.state["surfels"], pyramids, scene.core)
    with pytest.raises(ValueError, match="pyramids must hold at least one"):
        _core.shadow_links(ir.BodyCones(), caches, state["links"], sent, state["sites"], state["surfels"], [], scene.core)
