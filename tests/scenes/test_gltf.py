""".gltf and .glb: nodes, instances, materials, cameras and lights; graphs are walked without recursion and bounds hold."""

import base64
import copy
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scene_files import POSITIONS, glb, gltf, square_buffer, write, write_gltf, write_image

from interreflect.errors import SceneError
from interreflect.scenes.load import read_scene
from interreflect.scenes.values import DirectionalLight, PointLight, Scene, SpotLight

TURN = math.sqrt(0.5)


def load(folder: Path, **changes: Any) -> Scene:
    return read_scene(str(write_gltf(folder, **changes)))


def world(scene: Scene, k: int = 0) -> np.ndarray:
    mesh = scene.meshes[k]
    return (mesh.positions[mesh.triangles] @ mesh.transform[:3, :3].T + mesh.transform[:3, 3]).reshape(-1, 3)


SQUARE = POSITIONS[[0, 1, 2, 2, 1, 3]]


def test_gltf_glb_and_embedded_buffers_are_the_same_scene(tmp_path: Path) -> None:
    plain = load(tmp_path)
    content = gltf(buffers=[{"byteLength": 60}])
    (tmp_path / "b.glb").write_bytes(glb(content, square_buffer()))
    uri = "data:application/octet-stream;base64," + base64.b64encode(square_buffer()).decode()
    (tmp_path / "c.gltf").write_text(json.dumps(gltf(buffers=[{"uri": uri, "byteLength": 60}])))
    assert np.array_equal(world(plain), SQUARE)
    assert plain.hash == read_scene(str(tmp_path / "b.glb")).hash == read_scene(str(tmp_path / "c.gltf")).hash


def test_nodes_multiply_down_the_tree(tmp_path: Path) -> None:
    nodes = [
        {"children": [1], "translation": [10, 0, 0]},
        {"children": [2], "rotation": [0, 0, TURN, TURN]},  # a quarter turn about z
        {"mesh": 0, "matrix": [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 1, 0, 0, 1]},
    ]
    scene = load(tmp_path, nodes=nodes)
    x, y, z = (SQUARE * 2 + [1, 0, 0]).T
    assert np.allclose(world(scene), np.stack([10 - y, x, z], 1), atol=1e-6)


def test_a_mesh_in_many_nodes_is_stored_once(tmp_path: Path) -> None:
    nodes = [{"mesh": 0, "translation": [k, 0, 0]} for k in range(5)]
    scene = load(tmp_path, nodes=nodes, scenes=[{"nodes": [0, 1, 2, 3, 4]}])
    assert scene.triangles == 10 and all(mesh.positions is scene.meshes[0].positions for mesh in scene.meshes)
    assert np.allclose(world(scene, 3), np.add(SQUARE, [3, 0, 0]))


def test_a_tree_deeper_than_any_stack_loads(tmp_path: Path) -> None:
    deep = 20_000
    nodes: list[dict[str, Any]] = [{"children": [k + 1], "translation": [1, 0, 0]} for k in range(deep)]
    scene = load(tmp_path, nodes=[*nodes, {"mesh": 0}])
    assert np.allclose(world(scene), np.add(SQUARE, [deep, 0, 0]))


@pytest.mark.parametrize(
    ("mode", "order"),
    [(4, [[0, 1, 2], [2, 1, 3]]), (5, [[0, 1, 2], [1, 3, 2]]), (6, [[1, 2, 0], [2, 3, 0]]), (None, [[0, 1, 2], [2, 1, 3]])],
)
def test_strips_and_fans_become_triangles(tmp_path: Path, mode: int | None, order: list) -> None:
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}}
    if mode in (None, 4):
        primitive["indices"] = 1
    if mode is not None:
        primitive["mode"] = mode
    scene = load(tmp_path, meshes=[{"primitives": [primitive]}])
    assert np.array_equal(world(scene), POSITIONS[order].reshape(-1, 3))


def test_materials_follow_the_format(tmp_path: Path) -> None:
    write_image(tmp_path / "base.png", np.full((2, 2, 4), (10, 200, 30, 100), np.uint8))
    materials = [
        {"name": "gold", "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0.5, "roughnessFactor": 0.25}},
        {
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 0}},
            "emissiveFactor": [1, 0.5, 0],
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}},
            "alphaMode": "MASK",
            "alphaCutoff": 0.3,
        },
    ]
    primitives = [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": k} for k in (0, 1)]
    content = gltf()
    scene = load(
        tmp_path,
        materials=materials,
        meshes=[{"primitives": primitives}],
        accessors=[*content["accessors"], {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"}],
        textures=[{"source": 0}],
        images=[{"uri": "base.png"}],
    )
    gold, cut = (mesh.material for mesh in scene.meshes)
    assert gold.name == "gold" and np.allclose(gold.albedo, [0.5, 0.25, 0.125]) and gold.roughness == 0.25
    assert np.allclose(gold.specular, [0.52, 0.27, 0.145])  # 0.04 + (base - 0.04) metallic
    assert cut.name == "material1" and cut.albedo == (1, 1, 1) and np.allclose(cut.specular, 0.04) and cut.emission == (8, 4, 0)
    assert cut.albedo_map is not None and cut.albedo_map.pixels[0, 0].tolist() == [10, 200, 30]  # not multiplied by alpha
    assert cut.mask is not None and cut.mask.solid.all()  # 100 / 255 is above 0.3
    x, y = POSITIONS.ravel()[:8].reshape(4, 2).T
    assert np.allclose(scene.meshes[0].texcoords, np.stack([x, 1 - y], 1))  # v counts from the top


def test_an_embedded_image_is_a_texture_and_a_missing_one_a_warning(tmp_path: Path) -> None:
    write_image(tmp_path / "t.png", np.full((1, 1, 3), 7, np.uint8))
    uri = "data:image/png;base64," + base64.b64encode((tmp_path / "t.png").read_bytes()).decode()
    content = gltf()
    for image, wanted in (({"uri": uri}, True), ({"uri": "absent%20one.png"}, False)):
        scene = load(
            tmp_path,
            materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
            meshes=[{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}]}],
            accessors=[*content["accessors"], {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC2"}],
            textures=[{"source": 0}],
            images=[image],
        )
        assert (scene.meshes[0].material.albedo_map is not None) == wanted
        assert wanted or "'absent one.png' does not exist" in scene.warnings[0]


def test_cameras_and_lights_stand_where_their_nodes_are(tmp_path: Path) -> None:
    lights = [
        {"type": "point", "color": [1, 0.5, 0], "intensity": 4},
        {"type": "directional", "intensity": 2},
        {"type": "spot", "intensity": 3, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}},
    ]
    nodes: list[dict[str, Any]] = [{"mesh": 0}, {"camera": 0, "name": "view", "translation": [1, 2, 3], "rotation": [0, TURN, 0, TURN]}]
    nodes += [{"translation": [0, k, 0], "extensions": {"KHR_lights_punctual": {"light": k}}} for k in range(3)]
    scene = load(
        tmp_path,
        nodes=nodes,
        scenes=[{"nodes": [0, 1, 2, 3, 4]}],
        cameras=[{"type": "perspective", "perspective": {"yfov": math.radians(60), "aspectRatio": 2}}],
        extensionsUsed=["KHR_lights_punctual"],
        extensions={"KHR_lights_punctual": {"lights": lights}},
    )
    camera = scene.cameras["view"]
    assert np.allclose(camera.position, [1, 2, 3]) and np.allclose(np.subtract(camera.target, camera.position), [-1, 0, 0])  # -z turned
    assert math.isclose(camera.fov_x, 2 * math.degrees(math.atan(2 * math.tan(math.radians(30)))))
    point, sun, spot = scene.lights
    assert isinstance(point, PointLight) and point.intensity == (4, 2, 0) and point.position == (0, 0, 0)
    assert isinstance(sun, DirectionalLight) and np.allclose(sun.direction, [0, 0, -1]) and sun.irradiance == (2, 2, 2)
    assert isinstance(spot, SpotLight) and math.isclose(spot.inner, math.degrees(0.1)) and math.isclose(spot.outer, math.degrees(0.2))


def changed(path: str, value: Any) -> dict[str, Any]:
    """The square with the entry at a path like "accessors.0.count" replaced, or removed where the value is `...`."""
    content = copy.deepcopy(gltf())
    at: Any = content
    *keys, last = [int(key) if key.isdecimal() else key for key in path.split(".")]
    for key in keys:
        at = at[key]
    if value is ...:
        del at[last]
    else:
        at[last] = value
    return content


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("asset", ..., "asset.version is missing"),
        ("asset.version", "1.0", "asset.version must be 2"),
        ("scenes", ..., "scenes is missing"),
        ("scene", 3, r"scene must be a whole number in \[0, 1\), got 3"),
        ("scenes.0.nodes", [7], r"scenes\[0\].nodes must be a list of whole numbers in \[0, 1\)"),
        ("scenes.0.nodes", "x", "scenes"),
        ("nodes.0.children", [0], r"nodes\[0\] has two parents or is a child of itself"),
        ("nodes.0.mesh", 2, r"nodes\[0\].mesh"),
        ("nodes.0.mesh", 0.5, r"nodes\[0\].mesh"),
        ("nodes.0.matrix", [0] * 15, r"nodes\[0\].matrix must be 16 finite numbers"),
        ("nodes.0.matrix", [0] * 15 + [1], r"transform must be invertible"),
        ("nodes.0.scale", [1, 1e39, 1], r"nodes\[0\].scale"),
        ("nodes.0.rotation", [0, 0, 0, 0], "unit quaternion"),
        ("nodes", {}, "nodes must be a list"),
        ("nodes", [3], r"nodes\[0\] must be an object"),
        ("meshes.0.primitives.0.attributes", {}, "attributes.POSITION is missing"),
        ("meshes.0.primitives.0.attributes.POSITION", 7, r"POSITION must be a whole number in \[0, 2\), got 7"),
        ("meshes.0.primitives.0.attributes.POSITION", 1, "must be the number of an accessor of type VEC3"),
        ("meshes.0.primitives.0.indices", 0, "must be the number of an accessor of type SCALAR"),
        ("meshes.0.primitives.0.material", 0, "material"),
        ("meshes.0.primitives.0.mode", 9, "mode"),
        ("accessors.0.count", 5, r"accessors\[0\].count of 5 rows of 12 bytes does not fit"),
        ("accessors.0.count", 2**31, "does not fit"),
        ("accessors.0.count", -1, "count"),
        ("accessors.0.byteOffset", 4, "does not fit"),
        ("accessors.0.bufferView", ..., "bufferView is missing or sparse"),
        ("accessors.0.sparse", {}, "sparse"),
        ("accessors.0.componentType", 5130, "known"),
        ("accessors.1.componentType", 5122, "unsigned"),
        ("accessors.1.count", 5, "multiple of three"),
        ("bufferViews.0.byteStride", 4, "does not fit"),
        ("bufferViews.0.buffer", 1, "buffer"),
        ("bufferViews.1.byteOffset", 60, "byteLength"),
        ("buffers.0.byteLength", 61, r"buffers\[0\].byteLength must be at most the 60 bytes"),
        ("buffers.0.uri", "absent.bin", "'absent.bin' does not exist"),
        ("buffers.0.uri", "../../../../etc/passwd", "must not lead above"),
        ("buffers.0.uri", "%2e%2e/%2e%2e/%2e%2e/etc/passwd", "must not lead above"),
        ("buffers.0.uri", "/etc/hostname", "relative path"),
        ("buffers.0.uri", "file:///etc/hostname", "without a scheme"),
        ("buffers.0.uri", "\ud800.bin", "must be a string"),
        ("buffers.0.uri", "a%00.bin", "must be a relative path"),
        ("buffers.0.uri", "a" * 5000, "does not exist"),
        ("buffers.0.uri", "data:text/plain,hello", "base64"),
        ("buffers.0.uri", "data:;base64,%%%", "base64"),
        ("buffers.0.uri", ..., "uri is missing"),
        ("extensionsRequired", ["KHR_draco_mesh_compression"], "which is not read"),
        ("extensionsRequired", 3, "list of strings"),
    ],
)
def test_what_is_malformed_is_refused_with_its_key(tmp_path: Path, path: str, value: Any, message: str) -> None:

    folder = tmp_path / "in" / "side"
    write(folder, square_bin=square_buffer(), square_gltf=json.dumps(changed(path, value)))
    with pytest.raises(SceneError, match=message) as error:
        read_scene(str(folder / "square.gltf"))
    assert str(error.value).startswith("side/square.gltf")


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is no JSON"),
        (b"[]", "must hold an object"),
        (b"\xff\xfe", "is no JSON"),
        (b'{"asset":{"version":"2.0"},"x":NaN}', "NaN is no number of JSON"),
        (b'{"asset":{"version":"2.0"},"x":' + b"9" * 10_000 + b"}", "is no JSON"),
        (b'{"asset":{"version":"2.0"},"extras":' + b"[" * 100_000 + b"]" * 100_000 + b"}", "JSON nested 100001 deep"),
        (b'{"asset":{"version":"2.0"},"extras":"' + b"[" * 1000 + b'"}', "scenes is missing"),  # brackets in a string nest nothing
        (b'{"a":' * 5000, "JSON nested 5000 deep"),
        (b'{"a":"' + b'\\"' * 500_000, "is no JSON"),
        (b'{"a":"' + b'\\"' * 500_000 + b"\\", "is no JSON"),
    ],
)
def test_json_is_parsed_within_bounds(tmp_path: Path, data: bytes, message: str) -> None:
    (tmp_path / "a.gltf").write_bytes(data)
    with pytest.raises(SceneError, match=message):
        read_scene(str(tmp_path / "a.gltf"))


@pytest.mark.parametrize("cut", [0, 3, 11, 15, 40, -20])
def test_a_glb_cut_short_is_refused(tmp_path: Path, cut: int) -> None:
    (tmp_path / "a.glb").write_bytes(glb(gltf(buffers=[{"byteLength": 60}]), square_buffer())[:cut])
    with pytest.raises(SceneError, match=r"a\.glb"):
        read_scene(str(tmp_path / "a.glb"))


def test_non_finite_positions_are_refused(tmp_path: Path) -> None:
    data = bytearray(square_buffer())
    data[0:4] = np.float32(np.inf).tobytes()
    write_gltf(tmp_path)
    (tmp_path / "square.bin").write_bytes(data)
    with pytest.raises(SceneError, match=r"meshes\[0\].primitives\[0\]: position 0 must be finite"):
        read_scene(str(tmp_path / "square.gltf"))


def test_accessors_named_over_and_over_do_not_fill_the_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("interreflect.scenes.gltf_buffers.MAX_ROWS", 1000)
    primitives = [{"attributes": {"POSITION": 0}, "indices": 1}] * 167  # of four vertices and two triangles
    with pytest.raises(SceneError, match=r"meshes\[0\].primitives\[166\] makes more than the 1000 vertices and triangles"):
        load(tmp_path, meshes=[{"primitives": primitives}])


def test_many_nodes_meshes_and_lights_load_in_bounded_time(tmp_path: Path) -> None:
    many = 3000
    nodes = [{"mesh": k, "extensions": {"KHR_lights_punctual": {"light": k}}} for k in range(many)]
    scene = load(
        tmp_path,
        nodes=nodes,
        scenes=[{"nodes": list(range(many))}],
        meshes=gltf()["meshes"] * many,
        extensions={"KHR_lights_punctual": {"lights": [{"type": "point"}] * many}},
    )
    assert scene.triangles == 2 * many and len(scene.lights) == many
