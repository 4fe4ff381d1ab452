"""Bodies with voxels of their own: they compose with the rest of the scene, and move without being voxelized again."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from voxel_scenes import box, floor, quad, scene_of

import interreflect as ir
from interreflect import _core
from interreflect.stages import body_domain, move_voxels

SIZE = (64, 48)
CAMERA = ir.Camera(position=(0.4, 2.6, 3.4), target=(0, 0.3, 0), fov_x=55)
SUN = ir.DirectionalLight(direction=(0.3, -1, 0.2), irradiance=(3, 2, 1))
RESOLUTION = 48


def at(x=0.0, y=0.0, z=0.0, turn=0.0):
    """A pose: turned about y by `turn` degrees, then moved."""
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    return np.array([[c, 0, s, x], [0, 1, 0, y], [-s, 0, c, z], [0, 0, 0, 1]], float)


def room(*bodies, lights=(SUN,), **keys):
    """A floor with a wall behind, and bodies."""
    wall = quad([[-2, 0, -1.5], [2, 0, -1.5], [2, 2, -1.5], [-2, 2, -1.5]], albedo=(0.7, 0.2, 0.2))
    return scene_of(floor(0, half=2, albedo=(0.6, 0.6, 0.6)), wall, *bodies, lights=lights, cameras={"view": CAMERA}, **keys)


def cube(body, colour=(0.2, 0.7, 0.3), half=0.25):
    return box((-half,) * 3, (half,) * 3, body=body, material=ir.Material(albedo=colour))


TWO = room(cube("a"), cube("b", (0.2, 0.3, 0.8)), bodies={"a": at(-0.5, 0.5, 0.2, 30), "b": at(0.45, 0.9, 0.1, 10)})


def parts(scene, technique=None, filters=None, light=None):
    """The pyramids of what stands still and of every body, made from voxels of one size."""
    voxelize = technique or ir.ExactOverlap()
    domain = ir.Grid(resolution=RESOLUTION).place(scene)
    grids = {"world": ir.voxelize(voxelize, scene, domain, body="world")}
    for body in list(scene.bodies)[1:]:
        own = ir.voxelize(voxelize, scene, body_domain(scene, body, domain.voxel_size), body=body)
        grids[body] = move_voxels(own, scene, body)
    light = light or ir.TracedLighting(samples=4, both_sides=True)
    return {
        name: ir.prefilter(
            filters or ir.OctantCoverage(), ir.light_voxels(light, scene, grid, others=[g for o, g in grids.items() if o != name])
        )
        for name, grid in grids.items()
    }


def whole(scene, technique=None, filters=None):
    voxels = ir.voxelize(technique or ir.ExactOverlap(), scene, ir.Grid(resolution=RESOLUTION).place(scene))
    lit = ir.light_voxels(ir.TracedLighting(samples=4, both_sides=True), scene, voxels)
    return ir.prefilter(filters or ir.OctantCoverage(), lit)


def relative(a, b):
    return float(np.abs(np.asarray(a, float) - np.asarray(b, float)).mean() / np.abs(np.asarray(b, float)).mean())


def test_what_cones_see_through_several_hierarchies_multiplies_exactly():
    gbuffer = ir.trace_gbuffer(TWO, size=SIZE)
    pyramids = parts(TWO, filters=ir.SurfaceCoverage())
    lit = lambda *names: np.asarray(  # noqa: E731
        ir.shadow(ir.VoxelCones(half_angle=4), TWO, gbuffer, pyramids=[pyramids[n] for n in names]).radiance, float
    )[np.asarray(gbuffer.body) == 0]
    still, a, b, both = lit("world"), lit("world", "a"), lit("world", "b"), lit("world", "a", "b")
    seen = still > 1e-3
    assert (a[seen] < 0.9 * still[seen]).any() and (b[seen] < 0.9 * still[seen]).any()
    assert np.allclose(both[seen], a[seen] * b[seen] / still[seen], rtol=1e-4, atol=1e-6)
    assert np.allclose(lit("b", "world", "a")[seen], both[seen], rtol=1e-5, atol=1e-7)


def aligned(scene):
    """Pyramids of the scene's parts whose voxels are the whole grid's own: bodies stand at the identity."""
    domain = ir.Grid(resolution=RESOLUTION).place(scene)
    technique, light = ir.ExactOverlap(), ir.TracedLighting(samples=4, both_sides=True)
    return [
        ir.prefilter(ir.OctantCoverage(), ir.light_voxels(light, scene, ir.voxelize(technique, scene, domain, body=body)))
        for body in scene.bodies
    ]


def test_bodies_in_the_same_voxels_look_as_in_one_grid():
    """Claim R11. What differs: texels in which two parts meet, and the order in which parts of a coarse texel lie."""
    scene = room(
        box((-0.8, 0.2, -0.2), (-0.3, 0.7, 0.3), body="a", material=ir.Material(albedo=(0.2, 0.7, 0.3))),
        box((0.2, 0.5, -0.4), (0.7, 1.0, 0.1), body="b", material=ir.Material(albedo=(0.2, 0.3, 0.8))),
        box((-0.3, 1.2, -0.6), (0.3, 1.4, 0.2), body="c", material=ir.Material(albedo=(0.9, 0.8, 0.1))),
    )
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    hit = np.asarray(gbuffer.depth) < np.inf
    one, several = (ir.march(ir.DiffuseCones(), p, gbuffer, scene) for p in (whole(scene), aligned(scene)))
    assert relative(np.asarray(several.occlusion)[hit], np.asarray(one.occlusion)[hit]) < 0.005
    assert relative(np.asarray(several.irradiance)[hit], np.asarray(one.irradiance)[hit]) < 0.015


def test_shadows_through_bodies_in_the_same_voxels_are_those_of_one_grid():
    """Claim R11: shadows compose exactly. No two parts share a texel that a narrow cone reads."""
    scene = room(
        box((-0.8, 0.2, -0.2), (-0.3, 0.7, 0.3), body="a"),
        box((0.2, 0.9, -0.4), (0.7, 1.4, 0.1), body="b"),
    )
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    one, several = (
        np.asarray(ir.shadow(ir.VoxelCones(half_angle=2), scene, gbuffer, pyramids=pyramids).radiance)
        for pyramids in ([whole(scene)], aligned(scene))
    )
    assert (one < 0.1 * one.max()).any() and relative(several, one) < 1e-4


def test_bodies_turned_and_moved_look_much_as_in_one_grid():
    gbuffer = ir.trace_gbuffer(TWO, size=SIZE)
    hit = np.asarray(gbuffer.depth) < np.inf
    one, several = (ir.march(ir.DiffuseCones(), p, gbuffer, TWO) for p in (whole(TWO), list(parts(TWO).values())))
    # Voxels of a turned body are turned with it, and fewer of them hold its surface: .054 and .040 here, where both differ from
    # what rays see by five times as much.
    assert relative(np.asarray(several.occlusion)[hit], np.asarray(one.occlusion)[hit]) < 0.08
    assert relative(np.asarray(several.irradiance)[hit], np.asarray(one.irradiance)[hit]) < 0.08


def test_the_order_of_three_bodies_in_a_row_does_not_depend_on_the_order_of_their_hierarchies():
    colours = {"near": (0.9, 0, 0), "middle": (0, 0.9, 0), "far": (0, 0, 0.9)}
    heights = {"near": 0.5, "middle": 1.0, "far": 1.5}
    plates = [box((-0.6, -0.03, -0.6), (0.6, 0.03, 0.6), body=name, material=ir.Material(albedo=c)) for name, c in colours.items()]
    lamps = [ir.PointLight(position=(0, y - 0.25, 0), intensity=(1, 1, 1)) for y in heights.values()]
    scene = room(*plates, lights=lamps, bodies={name: at(y=y) for name, y in heights.items()})
    gbuffer = ir.trace_gbuffer(scene, size=SIZE)
    pyramids = parts(scene)
    pictures = [
        np.asarray(ir.march(ir.DiffuseCones(), [pyramids["world"], *(pyramids[n] for n in order)], gbuffer, scene).irradiance, float)
        for order in itertools.permutations(colours)
    ]
    for picture in pictures[1:]:
        assert relative(picture, pictures[0]) < 0.01
    place = np.asarray(gbuffer.position)
    below = (np.abs(place[..., 0]) < 0.3) & (np.abs(place[..., 2]) < 0.3) & (place[..., 1] < 0.01)
    red, green, blue = pictures[0][below].mean(0)
    assert below.any() and red > 20 * max(green, blue)


@pytest.mark.parametrize("turn", [0.0, 90.0])
def test_moved_voxels_are_those_of_the_moved_body_where_grids_agree(turn):
    scene = room(cube("a"), bodies={"a": at()})
    own = ir.voxelize(ir.ExactOverlap(), scene, body_domain(scene, "a", 1 / 16), body="a")
    # By whole voxels; quarter turns bring a cubic grid about the origin onto itself.
    moved = scene.replace(bodies={"a": at(0.5, 0.75, -0.25, turn)})
    there = move_voxels(own, moved, "a")
    lower = np.add(own.domain.lower, (0.5, 0.75, -0.25))
    fresh = ir.voxelize(
        ir.ExactOverlap(),
        scene_of(box((0.25, 0.5, -0.5), (0.75, 1.0, 0.0), material=ir.Material(albedo=(0.2, 0.7, 0.3)))),
        _core.Domain(lower=tuple(lower), voxel_size=own.domain.voxel_size, cells=own.domain.cells),
    )
    sort = lambda grid: np.lexsort(np.round(np.asarray(grid.position) * 1e4).T)  # noqa: E731
    a, b = sort(there), sort(fresh)
    assert len(there) == len(fresh)
    for name in ("position", "normal", "albedo", "opacity", "area"):
        assert np.allclose(np.asarray(getattr(there, name))[a], np.asarray(getattr(fresh, name))[b], atol=1e-4), name


def test_a_body_that_moves_is_not_voxelized_again():
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION), bodies="apart")
    prepared = method.prepare(TWO)
    first = prepared.render(size=SIZE)
    moved = TWO.replace(bodies={"a": at(-0.25, 0.5, 0.25, 75)})
    later = prepared.render(size=SIZE, scene=moved, history=first.history)
    assert first.profile.stages["voxelize"].counts.get("samples", 0) > 0  # of what stands still
    assert later.profile.stages["voxelize"].counts.get("samples", 0) == 0
    fresh = method.prepare(moved).render(size=SIZE)
    # Fresh voxels are brought back from where the body is, which rounds.
    assert relative(later.image, fresh.image) < 2e-3
    assert relative(later.image, first.image) > 0.01


def test_without_bodies_apart_is_together():
    scene = room(cube("world"))
    pictures = [
        ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION), bodies=bodies).render(scene, size=SIZE)
        for bodies in ("together", "apart")
    ]
    assert np.array_equal(pictures[0].image, pictures[1].image)


def test_copies_of_a_body_share_their_voxels_and_are_lit_each_where_they_are():
    scene = room(cube("car"), bodies={"car": at(-1, 0.5, 0)}).instance("car", [at(0, 0.5, 0.3, 20), at(1, 1.2, 0)])
    prepared = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION), bodies="apart").prepare(scene)
    kept = prepared.state["bodies"]
    assert list(kept) == ["car", "car.1", "car.2"] and len({id(grid) for grid in kept.values()}) == 1
    together = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=RESOLUTION)).render(scene, size=SIZE)
    assert relative(prepared.render(size=SIZE).indirect, together.indirect) < 0.15


@pytest.mark.parametrize(
    "knobs",
    [
        {"march": ir.TracedRays(samples=32), "glossy": None},
        {"light_voxels": ir.ConeLighting(), "shadow": ir.VoxelCones(), "prefilter": ir.SurfaceCoverage()},
        {"light_voxels": ir.ShadowMapInjection(size=256)},
        {"light_voxels": ir.BlendHistory()},
        {"grid": ir.Grid(resolution=RESOLUTION, warp=ir.Logistic())},
        {"prefilter": ir.Anisotropic()},
        {"prefilter": ir.SphericalHarmonicVoxels()},
    ],
    ids=lambda knobs: "-".join(type(value).__name__ for value in knobs.values()),
)
def test_every_technique_renders_bodies_apart_much_as_together(knobs):
    method = ir.methods.VoxelConeTracing(**{"grid": ir.Grid(resolution=RESOLUTION), **knobs})
    frames = []
    for bodies in ("together", "apart"):
        prepared = method.replace(bodies=bodies).prepare(TWO)
        first = prepared.render(size=SIZE)
        frames.append(prepared.render(size=SIZE, seed=1, history=first.history))
    # Rays see the same surfaces: only voxels differ. Cones also mix voxels of other places.
    assert relative(frames[1].image, frames[0].image) < 0.08


def test_light_of_all_bounces_does_not_go_with_bodies_apart():
    with pytest.raises(ValueError, match="Bounces gathers in one hierarchy"):
        ir.methods.VoxelConeTracing(light_voxels=ir.Bounces(), bodies="apart")


def test_bodies_are_named_in_errors():
    domain = ir.Grid(resolution=8).place(TWO)
    with pytest.raises(ValueError, match="no body 'cat'; it has world, a, b"):
        ir.voxelize(ir.ExactOverlap(), TWO, domain, body="cat")
    with pytest.raises(ValueError, match="only voxels of a body can move"):
        move_voxels(ir.voxelize(ir.ExactOverlap(), TWO, domain), TWO, "a")
    with pytest.raises(ValueError, match="at least one Pyramid"):
        ir.march(ir.DiffuseCones(), [], ir.trace_gbuffer(TWO, size=SIZE), TWO)
