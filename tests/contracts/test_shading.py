"""Contracts of the stage `shade`: direct and indirect light reflect by one lobe, and each lobe is what its formula says."""

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core

SHADE = [ir.Exact(), ir.FreedCookTorrance(), ir.BlinnPhong(), ir.BlinnPhong(scale="common")]
ROUGHNESS, SPECULAR = 0.6, 0.3
SUN, SIZE = np.array([0.5, -0.6, 0.2]), (24, 18)


def floor(**material):
    """A floor under a slanted sun, seen from above."""
    corners = np.array([[-5, 0, -5], [-5, 0, 5], [5, 0, 5], [5, 0, -5]], np.float32)
    mesh = ir.Mesh(corners, np.array([[0, 1, 2], [0, 2, 3]], np.uint32), material=ir.Material(**material))
    return ir.Scene(meshes=[mesh], lights=[ir.DirectionalLight(direction=tuple(SUN), irradiance=(2.0, 2.0, 2.0))],
                    cameras={"view": ir.Camera(position=(1, 2, 0.5), target=(0.2, 0, 0), fov_x=60)})  # fmt: skip


def lobe(technique, cos_o, cos_i, cos_h, cos_oh):
    """f of the glossy lobe, as published (GROUND_TRUTH.md, SCENE_FORMAT.md; Freed 2018, 4.5.1 as the errata correct it)."""
    alpha = ROUGHNESS**2
    if isinstance(technique, ir.BlinnPhong):
        n = 2 / alpha**2 - 2
        common = (n + 8) / (8 * np.pi)
        exact = (n + 2) * (n + 4) / (8 * np.pi * (2 ** (-n / 2) + n))
        return SPECULAR * (common if technique.scale == "common" else exact) * cos_h**n
    distribution = alpha**2 / (np.pi * (cos_h**2 * (alpha**2 - 1) + 1) ** 2)
    fresnel = SPECULAR + (1 - SPECULAR) * (1 - cos_oh) ** 5
    if isinstance(technique, ir.FreedCookTorrance):
        k = (ROUGHNESS + 1) ** 2 / 8
        shadowing = [c / (c * (1 - k) + k) for c in (cos_o, cos_i)]
        return distribution * fresnel * shadowing[0] * shadowing[1] / (4 * cos_o * cos_i)
    smith = [np.sqrt(alpha**2 + (1 - alpha**2) * c**2) for c in (cos_o, cos_i)]
    return distribution * fresnel * 0.5 / (cos_i * smith[0] + cos_o * smith[1])


@pytest.mark.parametrize("technique", SHADE, ids=repr)
@pytest.mark.parametrize("shadow", ir.techniques("shadow"), ids=lambda cls: cls.__name__)
def test_direct_light_reflects_by_the_published_formula(shadow, technique):
    scene = floor(albedo=(0.4,) * 3, specular=(SPECULAR,) * 3, roughness=ROUGHNESS)
    gbuffer = ir.trace_gbuffer(scene, "view", SIZE, shade=technique)
    pyramids = [pyramid_of(scene)] if shadow is ir.VoxelCones else []
    found = ir.shadow(shadow(), scene, gbuffer, pyramids=pyramids).radiance
    view = np.asarray(scene.cameras["view"].position) - gbuffer.position
    view /= np.linalg.norm(view, axis=2, keepdims=True)
    light = -SUN / np.linalg.norm(SUN)
    half = view + light
    half /= np.linalg.norm(half, axis=2, keepdims=True)
    cosine = light[1]
    f = 0.4 / np.pi + lobe(technique, view[..., 1], cosine, half[..., 1], (half * light).sum(2))
    np.testing.assert_allclose(found[..., 0], 2 * cosine * f, rtol=2e-4)  # single precision, powers of small cosines


@pytest.mark.parametrize("technique", SHADE, ids=repr)
def test_the_glossy_cone_weighs_what_it_sees_by_the_lobes_albedo(technique):
    scene = furnace(specular=(0.4, 0.1, 0.02), roughness=0.5)
    gbuffer = ir.trace_gbuffer(scene, "view", (48, 36), shade=technique)
    pyramid = pyramid_of(scene)
    light = ir.glossy(ir.GlossyCone(), pyramid, gbuffer, scene)
    exact = ir.glossy(ir.TracedRays(samples=256), pyramid, gbuffer, scene, seed=2)
    assert light.radiance.mean((0, 1)) == pytest.approx(exact.radiance.mean((0, 1)), rel=0.07)  # cones lose as much between layers


def furnace(**material):
    """A cube whose walls all emit 1 and reflect half."""
    low, high = np.float32(-1), np.float32(1)
    corners = np.array([[x, y, z] for x in (low, high) for y in (low, high) for z in (low, high)], np.float32)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, c, b), (a, d, c))], np.uint32)
    mesh = ir.Mesh(corners, triangles, material=ir.Material(albedo=(0.5,) * 3, emission=(1.0,) * 3, **material))
    return ir.Scene(meshes=[mesh], cameras={"view": ir.Camera(position=(0.2, 0.1, 0.3), target=(-1, -0.4, -0.6), fov_x=90)})


def pyramid_of(scene):
    voxels = ir.voxelize(ir.SurfaceSampling(), scene, _core.place(ir.Grid(resolution=32), scene.core, None))
    return ir.prefilter(ir.SurfaceCoverage(), ir.light_voxels(ir.TracedLighting(samples=256), scene, voxels))


def test_none_named_is_exact():
    scene = ir.scenes.cornell_box(box="glossy")
    gbuffers = [ir.trace_gbuffer(scene, size=SIZE, **how) for how in ({}, {"shade": ir.Exact()})]
    pictures = [ir.shadow(ir.TracedShadows(), scene, gbuffer).radiance for gbuffer in gbuffers]
    assert np.array_equal(*pictures)


@pytest.mark.parametrize("technique", SHADE[1:], ids=repr)
def test_shading_changes_what_is_glossy_and_nothing_else(technique):
    for scene, same in ((ir.scenes.cornell_box(), True), (ir.scenes.cornell_box(box="glossy"), False)):
        method = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16))
        plain, changed = (one.render(scene, size=SIZE).image for one in (method, method.replace({"shade": technique})))
        assert np.array_equal(plain, changed) == same
        assert np.isfinite(changed).all()


def test_a_material_with_an_exponent_keeps_it_under_blinn_phong():
    # The same lobe by two ways: the material's own, and the stage's in the place of a Phong lobe of that exponent.
    shown = []
    for lobe_name, shade in (("blinn-phong", ir.Exact()), ("phong", ir.BlinnPhong())):
        scene = floor(specular=(0.5,) * 3, exponent=30.0, lobe=lobe_name)
        shown.append(ir.shadow(ir.TracedShadows(), scene, ir.trace_gbuffer(scene, "view", SIZE, shade=shade)).radiance)
    assert np.array_equal(*shown)
