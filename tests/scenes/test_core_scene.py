"""Scene values become the core's scene: what was loaded is what rays meet, and derived scenes share what they can."""

import json
from pathlib import Path

import numpy as np
import pytest
from scene_files import POSITIONS, TRIANGLE, gltf, square_buffer, write, write_image

import interreflect as ir
from interreflect.scenes.load import read_scene
from interreflect.scenes.values import Camera, EnvironmentLight, Mask, Material, Mesh, PointLight, Scene, Texture

QUAD = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
CORNERS = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)
FRONT = Camera(position=(0, 0, 3), target=(0, 0, 0), fov_x=40)
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)


def quarters(image: np.ndarray) -> list[list[float]]:
    """The pixels in the middle of the top left, top right, bottom left and bottom right quarter of a centred picture."""
    height, width = image.shape[:2]
    return [image[height * y // 8, width * x // 8].tolist() for y, x in ((3, 3), (3, 5), (5, 3), (5, 5))]


def test_row_0_of_an_image_is_its_top_in_obj_and_in_gltf(tmp_path: Path) -> None:
    image = np.zeros((16, 16, 3), np.uint8)
    image[:8, :8], image[:8, 8:], image[8:, :8], image[8:, 8:] = RED, GREEN, BLUE, WHITE
    write_image(tmp_path / "t.png", image)
    write(
        tmp_path,
        a_obj="mtllib a.mtl\nusemtl a\n" + TRIANGLE + "v 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 4/4 3/3\n",
        a_mtl="newmtl a\nmap_Kd t.png\n",
        square_bin=square_buffer() + np.stack([POSITIONS[:, 0], 1 - POSITIONS[:, 1]], 1).tobytes(),
    )
    content = gltf(
        meshes=[{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}]}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}}],
        textures=[{"source": 0}],
        images=[{"uri": "t.png"}],
        buffers=[{"uri": "square.bin", "byteLength": 92}],
    )
    content["accessors"].append({"bufferView": 2, "componentType": 5126, "count": 4, "type": "VEC2"})
    content["bufferViews"].append({"buffer": 0, "byteOffset": 60, "byteLength": 32})
    (tmp_path / "a.gltf").write_text(json.dumps(content))
    camera = Camera(position=(0.5, 0.5, 2), target=(0.5, 0.5, 0), fov_x=40)
    for name in ("a.obj", "a.gltf"):
        gbuffer = ir.trace_gbuffer(read_scene(str(tmp_path / name)), camera, size=(64, 64))
        # the G-buffer decodes sRGB by a polynomial that is off by at most 2.1e-5
        assert np.allclose(quarters(gbuffer.albedo), [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1]], rtol=0, atol=2.2e-5), name


def test_a_mask_cuts_out_where_it_is_not_solid() -> None:
    mask = Mask(np.array([[True, False], [False, True]]))
    mesh = Mesh(QUAD, HALVES, texcoords=CORNERS, material=Material(albedo=(1, 1, 1), mask=mask))
    gbuffer = ir.trace_gbuffer(Scene(meshes=[mesh]), FRONT, size=(64, 64))
    assert quarters(gbuffer.albedo) == [[1, 1, 1], [0, 0, 0], [0, 0, 0], [1, 1, 1]]


@pytest.mark.parametrize("body", ["world", "lamp"])
@pytest.mark.parametrize("copies", [1, 2])
def test_a_mirroring_transform_keeps_the_emitting_front_in_front(body: str, copies: int) -> None:
    glow = Material(albedo=(0, 0, 0), emission=(2, 2, 2))
    for sign in (1, -1):
        transforms = [np.diag([sign, 1.0, 1, 1]), pose(50) @ np.diag([sign, 1.0, 1, 1])]
        meshes = [Mesh(QUAD, HALVES, material=glow, body=body, transform=transform) for transform in transforms[:copies]]
        scene = Scene(meshes=meshes)
        back = Camera(position=(0, 0, -3), target=(0, 0, 0), fov_x=40)
        assert quarters(ir.trace_gbuffer(scene, FRONT, size=(16, 16)).emission) == [[2, 2, 2]] * 4
        assert quarters(ir.trace_gbuffer(scene, back, size=(16, 16)).emission) == [[0, 0, 0]] * 4


def pose(x: float, z: float = 0) -> np.ndarray:
    result = np.eye(4)
    result[0, 3], result[2, 3] = x, z
    return result


def test_bodies_and_their_copies_stand_at_their_poses() -> None:
    half = np.diag([0.5, 0.5, 0.5, 1.0])
    scene = Scene(meshes=[Mesh(QUAD, HALVES, body="card", transform=half), Mesh(QUAD * 9 - [0, 0, 9], HALVES)])
    cards = scene.replace(bodies={"card": pose(-0.7)}).instance("card", [pose(0.7, -0.5)])
    gbuffer = ir.trace_gbuffer(cards, FRONT, size=(64, 64))
    middle = np.asarray(gbuffer.position)[32]
    bodies = np.asarray(gbuffer.body)[32]
    assert set(bodies.tolist()) == {0, 1, 2}
    assert np.allclose(middle[bodies == 1][:, 2], 0, atol=1e-5) and np.allclose(middle[bodies == 2][:, 2], -0.5, atol=1e-5)
    assert (middle[bodies == 1][:, 0] <= -0.199).all() and (middle[bodies == 2][:, 0] >= 0.199).all()


def test_scenes_that_differ_in_lights_cameras_or_names_share_one_hierarchy() -> None:
    texture = Texture(np.full((4, 4, 3), 99, np.uint8))
    mesh = Mesh(QUAD, HALVES, texcoords=CORNERS, material=Material(name="m", albedo_map=texture))
    scene = Scene(meshes=[mesh], lights=[PointLight(position=(0, 0, 1), intensity=(1, 1, 1))])
    parts = scene._compiled.parts
    for other in (scene.replace(lights=()), scene.replace(cameras={"a": FRONT}), scene.replace(name="other")):
        assert all(mine is theirs for mine, theirs in zip(other._compiled.parts, parts, strict=True))
    glossy = scene.replace(materials={"m": {"specular": (0.1, 0.1, 0.1)}})
    assert glossy._compiled.parts[1] is parts[1]  # the texture
    again = Scene(meshes=[Mesh(QUAD.copy(), HALVES.copy(), texcoords=CORNERS, material=Material(albedo_map=texture))])
    assert again._compiled.parts[0] is parts[0]  # by content, also between scenes made apart


def lit_floor(size: float) -> tuple[np.ndarray, np.ndarray]:
    """Where a floor of that extent is hit, and its picture under a point light and a sky."""
    scene = Scene(
        meshes=[Mesh(QUAD[:, [0, 2, 1]] * size, HALVES[:, ::-1], material=Material(albedo=(0.5, 0.5, 0.5)))],
        lights=[PointLight(position=(0, size, 0), intensity=(size * size,) * 3), EnvironmentLight(radiance=(0.5, 0.5, 0.5))],
    )
    camera = Camera(position=(0, size, 2 * size), target=(0, 0, 0), fov_x=50)
    gbuffer = ir.trace_gbuffer(scene, camera, size=(32, 32))
    hit = np.asarray(gbuffer.albedo)[..., 0] > 0
    assert np.abs(np.asarray(gbuffer.position)[hit][:, 1]).max() < 1e-5 * size
    frame = ir.methods.PathTracing(spp=4, bounces=1).render(scene, camera=camera, size=(32, 32), seed=1)
    return hit, frame.image


@pytest.mark.parametrize("size", [1e-6, 1e9])
def test_small_and_large_extents_make_the_same_picture(size: float) -> None:
    hit, image = lit_floor(size)
    unit_hit, unit_image = lit_floor(1.0)
    assert 0.2 < unit_hit.mean() < 0.8 and np.array_equal(hit, unit_hit)
    assert np.allclose(image, unit_image, rtol=1e-3)  # float rounding of positions; the same samples


def test_a_camera_inside_geometry_and_a_scene_without_light_give_finite_pictures() -> None:
    box = Mesh(QUAD, HALVES, material=Material(albedo=(0.9, 0.9, 0.9)))
    inside = Camera(position=(0, 0, 0), target=(0, 0, -1), fov_x=60)
    for scene in (Scene(meshes=[box]), Scene()):
        frame = ir.methods.PathTracing(spp=1, bounces=None).render(scene, camera=inside, size=(8, 8), seed=0)
        assert not frame.image.any()
