"""Contracts of the march, of the glossy lobe and of sharing, over every technique; and the method that is made of them."""

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core

MARCH, GLOSSY = ir.techniques("march"), ir.techniques("glossy")
SHARE = [ir.EveryPixel(), ir.Interleaved(width=2, height=2), ir.Interleaved(width=4, height=4)]
SIZE = (48, 36)
ROTATION = np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]], np.float64)  # a quarter turn about y: voxels turn with the scene


def quick(cls):
    """The technique, with few enough samples for a test."""
    return cls(samples=64) if cls is ir.TracedRays else cls()


def box(lower, upper, inward=False):
    """Positions and triangles of a box, facing out or in."""
    lower, upper = np.asarray(lower, np.float32), np.asarray(upper, np.float32)
    corners = np.array([[(lower, upper)[x][0], (lower, upper)[y][1], (lower, upper)[z][2]] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32)
    return corners.astype(np.float32), np.ascontiguousarray(triangles[:, ::-1] if inward else triangles)


def room(light=1.0, scale=1.0, shift=(0.0, 0.0, 0.0), turn=None, **material):
    """A closed room with a block and a lamp at a point, moved, turned and scaled as asked."""
    turn, shift = np.eye(3) if turn is None else turn, np.asarray(shift, np.float64)

    def place(points):
        return (np.asarray(points, np.float64) @ turn.T * scale + shift).astype(np.float32)

    def mesh(positions, triangles, albedo):
        return ir.Mesh(place(positions), triangles, material=ir.Material(albedo=albedo, **material))

    meshes = [mesh(*box((-1, 0, -1), (1, 2, 1), inward=True), (0.7, 0.5, 0.3)), mesh(*box((-0.6, 0, -0.5), (0, 0.9, 0.1)), (0.3, 0.5, 0.7))]
    camera = ir.Camera(position=tuple(place([[0.3, 1.2, 0.9]])[0]), target=tuple(place([[-0.1, 0.8, -1]])[0]), fov_x=80)
    lamp = ir.PointLight(position=tuple(place([[0.4, 1.6, 0.3]])[0]), intensity=(light * scale**2,) * 3)
    return ir.Scene(meshes=meshes, lights=[lamp] if light > 0 else [], cameras={"view": camera})


def pyramid_of(scene, resolution=32, prefilter=None):
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=resolution), scene.core, None))
    return ir.prefilter(prefilter or ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(), scene, voxels))


def marched(technique, scene, share=None, seed=3, resolution=32):
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    return gbuffer, ir.march(technique, pyramid_of(scene, resolution), gbuffer, scene, share=share, seed=seed)


def furnace(**material):
    """A cube whose walls all emit 1 and reflect half: every voxel reflects the same radiance, .5."""
    positions, triangles = box((-1, -1, -1), (1, 1, 1), inward=True)
    mesh = ir.Mesh(positions, triangles, material=ir.Material(albedo=(0.5,) * 3, emission=(1.0,) * 3, **material))
    return ir.Scene(meshes=[mesh], cameras={"view": ir.Camera(position=(0.2, 0.1, 0.3), target=(-1, -0.4, -0.6), fov_x=90)})


@pytest.mark.parametrize("share", SHARE, ids=lambda share: f"{type(share).__name__}{getattr(share, 'width', '')}")
@pytest.mark.parametrize("cls", MARCH)
def test_a_uniform_world_stays_uniform(cls, share):
    scene = furnace()
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=32), scene.core, None))
    pyramid = ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(samples=256), scene, voxels))
    light = ir.march(quick(cls), pyramid, gbuffer, scene, share=share, seed=1)
    # Voxels hold .5 within the noise of 256 samples; cones lose at most 7 % between layers of voxels and at the room's edges.
    assert light.irradiance.mean() == pytest.approx(0.5 * np.pi, rel=0.07)
    assert light.occlusion.mean() > 0.93
    assert np.percentile(abs(light.irradiance / light.irradiance.mean() - 1), 90) < (0.25 if cls is ir.TracedRays else 0.1)


@pytest.mark.parametrize("share", SHARE, ids=lambda share: f"{type(share).__name__}{getattr(share, 'width', '')}")
@pytest.mark.parametrize("cls", MARCH)
def test_above_an_infinite_plane_nothing_is_occluded_and_the_whole_sky_is_seen(cls, share):
    positions = np.array([[-5, 0, -5], [-5, 0, 5], [5, 0, 5], [5, 0, -5]], np.float32)
    floor = ir.Mesh(positions, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), material=ir.Material(albedo=(0.5,) * 3))
    scene = ir.Scene(meshes=[floor], lights=[ir.EnvironmentLight(radiance=(1.0, 2.0, 3.0))],
                     cameras={"view": ir.Camera(position=(0, 1, 0), target=(0.5, 0, 0.5), fov_x=60)})  # fmt: skip
    _, light = marched(quick(cls), scene, share)
    # The plane lies along the grid, so its own voxels are known and taken out; what is left are halves' roundings.
    assert abs(light.occlusion).max() < 0.02
    np.testing.assert_allclose(light.sky, np.broadcast_to(np.pi * np.array([1.0, 2.0, 3.0]), light.sky.shape), rtol=0.02)
    assert light.irradiance.max() < 0.02 * np.pi


@pytest.mark.parametrize("cls", MARCH)
def test_an_image_of_the_sky_weighs_as_much_as_its_mean_over_the_hemisphere(cls):
    # GROUND_TRUTH 15: radiance max(0, cos) of the angle to the normal gives 2 pi / 3.
    height, width = 32, 64
    up = np.maximum(0, np.cos(np.pi * (np.arange(height) + 0.5) / height)).astype(np.float32)
    image = np.ascontiguousarray(np.broadcast_to(up[:, None, None], (height, width, 3)))
    positions = np.array([[-5, 0, -5], [-5, 0, 5], [5, 0, 5], [5, 0, -5]], np.float32)
    floor = ir.Mesh(positions, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), material=ir.Material(albedo=(0.5,) * 3))
    scene = ir.Scene(meshes=[floor], lights=[ir.EnvironmentLight(radiance=(1.0,) * 3, image=image)],
                     cameras={"view": ir.Camera(position=(0, 1, 0), target=(0.5, 0, 0.5), fov_x=60)})  # fmt: skip
    _, light = marched(quick(cls), scene)
    # The filtered map's texels are 5 degrees wide; the set integrates the cosine exactly.
    assert light.sky.mean() == pytest.approx(2 * np.pi / 3, rel=0.02)


@pytest.mark.parametrize("cls", MARCH)
def test_a_wall_sees_the_part_of_the_sky_that_it_faces(cls):
    # Channels: radiance max(0, x), max(0, -x), max(0, z) of the direction. The integral of max(0, a) times the cosine is 2 pi / 3
    # facing a, 0 facing away, and 2 / 3 across.
    height, width = 32, 64
    theta, phi = np.pi * (np.arange(height) + 0.5) / height, 2 * np.pi * ((np.arange(width) + 0.5) / width - 0.5)
    x, z = np.outer(np.sin(theta), np.sin(phi)), -np.outer(np.sin(theta), np.cos(phi))
    image = np.ascontiguousarray(np.maximum(0, np.stack([x, -x, z], -1)), np.float32)
    front, across = 2 * np.pi / 3, 2 / 3
    for normal, expected in {
        (1, 0, 0): (front, 0, across), (-1, 0, 0): (0, front, across), (0, 0, 1): (across, across, front), (0, 0, -1): (across, across, 0),
    }.items():  # fmt: skip
        up = np.array((0.0, 1.0, 0.0))
        aside = np.cross(up, normal)
        corners = np.array([-aside - up, aside - up, aside + up, -aside + up], np.float32)
        wall = ir.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), material=ir.Material(albedo=(0.5,) * 3))
        eye = tuple(float(v) for v in np.asarray(normal) + 0.1 * up)
        scene = ir.Scene(meshes=[wall], lights=[ir.EnvironmentLight(radiance=(1.0,) * 3, image=image)],
                         cameras={"view": ir.Camera(position=eye, target=(0, 0, 0), fov_x=50)})  # fmt: skip
        _, light = marched(quick(cls), scene)
        # The filtered map's texels are 5 degrees wide, the cones 8: the edge of each half is as blurred.
        assert light.sky.mean((0, 1)) == pytest.approx(expected, abs=0.06)


@pytest.mark.parametrize("cls", MARCH)
def test_no_light_in_no_light_out(cls):
    _, light = marched(quick(cls), room(light=0.0))
    assert light.irradiance.max() == 0 and light.sky.max() == 0


@pytest.mark.parametrize("cls", MARCH)
def test_light_times_four_is_irradiance_times_four(cls):
    _, one = marched(quick(cls), room(light=1.0))
    _, four = marched(quick(cls), room(light=4.0))
    np.testing.assert_allclose(four.irradiance, 4 * one.irradiance, rtol=2e-3, atol=1e-6)  # texels are halves


@pytest.mark.parametrize("cls", MARCH)
@pytest.mark.parametrize("change", [{"shift": (64.0, 0.0, -32.0)}, {"scale": 1e-3}, {"scale": 1e3}, {"turn": ROTATION}], ids=str)
def test_moved_scaled_and_turned_scenes_look_the_same(cls, change):
    gbuffer, before = marched(quick(cls), room())
    _, after = marched(quick(cls), room(**change))
    seen = np.isfinite(gbuffer.depth)
    # Frames about normals turn with the world's axes, not with the scene: other rays, and other azimuths of the cones. Rounding
    # puts a face that lies on the border of two voxels into either.
    free = 0.05 if "turn" in change else 0.02
    assert after.irradiance[seen].mean() == pytest.approx(before.irradiance[seen].mean(), rel=free)
    assert after.occlusion[seen].mean() == pytest.approx(before.occlusion[seen].mean(), abs=0.02)


@pytest.mark.parametrize("cls", MARCH)
def test_cones_and_rays_see_the_same_room(cls):
    scene = room()
    _, truth = marched(ir.TracedRays(samples=256), scene, resolution=64)
    _, light = marched(quick(cls), scene, resolution=64)
    # The filter of wide cones mixes what lies beside them: a quarter of the mean, rms.
    error = np.sqrt(((light.irradiance - truth.irradiance) ** 2).mean()) / truth.irradiance.mean()
    assert error < 0.25 and light.irradiance.mean() == pytest.approx(truth.irradiance.mean(), rel=0.12)


@pytest.mark.parametrize("cls", MARCH)
def test_interleaved_pixels_agree_with_every_pixel(cls):
    _, every = marched(quick(cls), room(), ir.EveryPixel())
    for share in SHARE[1:]:
        _, shared = marched(quick(cls), room(), share)
        assert shared.irradiance.mean() == pytest.approx(every.irradiance.mean(), rel=0.03)
        close = abs(shared.irradiance - every.irradiance).mean() / every.irradiance.mean()
        assert close < (0.3 if cls is ir.TracedRays else 0.08)  # rays of the phases are other rays
        assert shared.counts.asdict().get("cones", 0) <= every.counts.asdict().get("cones", 0) / (share.width * share.height) * 1.1


@pytest.mark.parametrize("cls", [*MARCH, *GLOSSY], ids=lambda cls: cls.__name__)
def test_one_and_two_threads_give_the_same_bits(cls):
    scene = room(specular=(0.2,) * 3, roughness=0.3)
    gbuffer, pyramid = ir.trace_gbuffer(scene, "view", SIZE), pyramid_of(scene)
    pictures = []
    for threads in (1, 2):
        with _core.Threads(threads):
            if "march" in cls.stages:
                pictures.append(ir.march(quick(cls), pyramid, gbuffer, scene, share=SHARE[1], seed=5).irradiance.copy())
            if "glossy" in cls.stages:
                pictures.append(ir.glossy(quick(cls), pyramid, gbuffer, scene, seed=5).radiance.copy())
    half = len(pictures) // 2
    assert all(np.array_equal(a, b) for a, b in zip(pictures[:half], pictures[half:], strict=True))


@pytest.mark.parametrize("lobe", ["ggx", "phong", "blinn-phong"])
@pytest.mark.parametrize("cls", GLOSSY)
def test_a_lobe_reflects_its_albedo_of_a_uniform_world(cls, lobe):
    width = {"roughness": 0.5} if lobe == "ggx" else {"exponent": 40.0}
    scene = furnace(specular=(0.4, 0.1, 0.02), lobe=lobe, **width)  # of the last, most is what grazing angles add
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=32), scene.core, None))
    pyramid = ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(samples=256), scene, voxels))
    light = ir.glossy(quick(cls), pyramid, gbuffer, scene, seed=1)
    exact = ir.glossy(ir.TracedRays(samples=256), pyramid, gbuffer, scene, seed=2)
    assert light.radiance.mean((0, 1)) == pytest.approx(exact.radiance.mean((0, 1)), rel=0.07)  # as the diffuse cones above


@pytest.mark.parametrize("cls", GLOSSY)
def test_a_shiny_floor_shows_what_stands_ahead_and_not_what_stands_behind(cls):
    floor = ir.Mesh(*box((-2, -0.1, -2), (2, 0, 2)), material=ir.Material(albedo=(0.0,) * 3, specular=(0.9,) * 3, roughness=0.2))
    walls = [ir.Mesh(*box((-2, 0, z), (2, 2, z + 0.1)), material=ir.Material(albedo=(0.8,) * 3)) for z in (-2, 1.9)]
    view = ir.Camera(position=(0, 0.8, 1.2), target=(0, 0, -0.4), fov_x=40)
    ahead, behind = (
        scene_glossy(cls, ir.Scene(meshes=[floor, *walls], lights=[ir.DirectionalLight(direction=(0, -0.2, z), irradiance=(1,) * 3)],
                                   cameras={"view": view})) for z in (-1, 1))  # fmt: skip
    assert ahead.mean() > 0.05 and behind.mean() < 0.1 * ahead.mean()


def scene_glossy(technique, scene):
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=32), scene.core, None))
    pyramid = ir.prefilter(ir.OctantCoverage(), ir.light_voxels(ir.TracedLighting(both_sides=True), scene, voxels))
    return ir.glossy(quick(technique), pyramid, ir.trace_gbuffer(scene, "view", SIZE), scene, seed=1).radiance


def test_rays_see_the_side_of_a_voxel_that_they_meet():
    material = ir.Material(albedo=(0.5,) * 3)
    sheets = [
        ir.Mesh(np.array([[-1, y, -1], [-1, y, 1], [1, y, 1], [1, y, -1]], np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
                material=material) for y in (0, 0.5)]  # fmt: skip
    lights = [ir.DirectionalLight(direction=(0, -1, 0), irradiance=(1,) * 3), ir.PointLight(position=(0, 0.2, 0), intensity=(0.1,) * 3)]
    view = {"view": ir.Camera(position=(0.8, 0.3, 0.8), target=(0, 0, 0), fov_x=60)}
    seen = []
    for light in lights:  # on the upper sheet's top; between the two, on its underside
        scene = ir.Scene(meshes=sheets, lights=[light], cameras=view)
        voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=32), scene.core, None))
        pyramid = ir.prefilter(ir.OctantCoverage(), ir.light_voxels(ir.TracedLighting(both_sides=True), scene, voxels))
        gbuffer = ir.trace_gbuffer(scene, "view", SIZE)
        below = np.isfinite(gbuffer.depth) & (gbuffer.position[..., 1] < 0.1)
        seen.append(ir.march(ir.TracedRays(samples=64), pyramid, gbuffer, scene, seed=1).irradiance[below])
    assert seen[0].max() == 0 and seen[1].mean() > 0.01


def test_another_seed_sends_other_rays():
    scene = room(specular=(0.2,) * 3, roughness=0.3)
    gbuffer, pyramid = ir.trace_gbuffer(scene, "view", SIZE), pyramid_of(scene)
    marched = [ir.march(ir.TracedRays(samples=4), pyramid, gbuffer, scene, seed=s).irradiance.copy() for s in (1, 2)]
    shone = [ir.glossy(ir.TracedRays(samples=4), pyramid, gbuffer, scene, seed=s).radiance.copy() for s in (1, 2)]
    seen = np.isfinite(gbuffer.depth)
    for a, b in (marched, shone):
        assert (a != b).any(2)[seen].mean() > 0.5


@pytest.mark.parametrize("cls", GLOSSY)
def test_surfaces_without_a_lobe_reflect_nothing_glossy(cls):
    scene = room()
    light = ir.glossy(quick(cls), pyramid_of(scene), ir.trace_gbuffer(scene, "view", SIZE), scene)
    assert light.radiance.max() == 0 and light.sky.max() == 0 and not light.counts.asdict()


@pytest.mark.parametrize("cls", [*MARCH, *GLOSSY], ids=lambda cls: cls.__name__)
@pytest.mark.parametrize("resolution", [2, 3, 17])
def test_flat_and_tiny_grids_give_finite_light(cls, resolution):
    positions = np.array([[-5, 0, -5], [-5, 0, 5], [5, 0, 5]], np.float32)
    mesh = ir.Mesh(positions, np.array([[0, 1, 2]], np.uint32), material=ir.Material(specular=(0.3,) * 3, roughness=0.0))
    scene = ir.Scene(meshes=[mesh], lights=[ir.PointLight(position=(0, 1, 0), intensity=(1,) * 3)],
                     cameras={"view": ir.Camera(position=(-1, 2, 1), target=(-1.5, 0, 1.5), fov_x=60)})  # fmt: skip
    gbuffer, pyramid = ir.trace_gbuffer(scene, "view", SIZE), pyramid_of(scene, resolution)
    if "march" in cls.stages:
        light = ir.march(quick(cls), pyramid, gbuffer, scene)
        assert np.isfinite(light.irradiance).all() and np.isfinite(light.occlusion).all()
    if "glossy" in cls.stages:
        assert np.isfinite(ir.glossy(quick(cls), pyramid, gbuffer, scene).radiance).all()


@pytest.mark.parametrize(
    ("stage", "technique"), [(stage, cls) for stage in ("prefilter", "light_voxels", "shadow") for cls in ir.techniques(stage)]
)
def test_black_walls_with_an_emitter_have_no_indirect_light(stage, technique):
    walls = ir.Mesh(*box((-1, 0, -1), (1, 2, 1), inward=True), material=ir.Material(albedo=(0.0,) * 3))
    lamp = ir.Mesh(*box((-0.2, 1.5, -0.2), (0.2, 1.6, 0.2)), material=ir.Material(albedo=(0.0,) * 3, emission=(5.0,) * 3))
    scene = ir.Scene(meshes=[walls, lamp], cameras={"view": ir.Camera(position=(0.5, 1, 0.9), target=(0, 0.8, -1), fov_x=80)})
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=32)).replace({stage: technique()}).prepare(scene)
    first = method.render(size=SIZE)
    for frame in (first, method.render(size=SIZE, history=first.history)):
        assert frame.indirect.max() == 0 and frame.direct.max() > 1


@pytest.mark.parametrize(
    "changes",
    [{}, {"march": ir.TracedRays(samples=4)}, {"glossy": ir.TracedRays(samples=4)}, {"glossy": None}, {"share": ir.EveryPixel()},
     {"sky": ir.TracedSky(samples=1)}, {"prefilter": ir.Anisotropic()}, {"voxelize": ir.ExactOverlap()},
     {"light_voxels": ir.ShadowMapInjection(size=64)}, {"light_voxels": ir.ConeLighting(both_sides=True)}, {"light_voxels": ir.Bounces()},
     {"light_voxels": ir.BlendHistory(slabs=2)}, {"shadow": ir.VoxelCones()}, {"shade": ir.BlinnPhong()},
     {"glossy": ir.GlossyCone(share=ir.Interleaved())}],
    ids=str,
)  # fmt: skip
def test_the_method_takes_any_technique_of_each_stage(changes):
    method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=24)).replace(changes)
    frame = method.render(room(specular=(0.1,) * 3), size=SIZE)
    assert np.isfinite(frame.image).all() and frame.indirect.mean() > 0
    assert list(frame.profile.stages)[:4] == ["gbuffer", "voxelize", "light_voxels", "prefilter"]
