"""Whatever bytes a scene file holds, loading it gives a scene or a SceneError, soon and within bounded memory."""

import json
import struct
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from interreflect.errors import SceneError
from interreflect.scenes.load import read_scene
from interreflect.scenes.values import Scene

OBJ = b"""# a square
mtllib a.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 1 1 0.5
vt 0 0
vt 1 1
vn 0 0 1
vn 0 0 0
usemtl stone
f 1/1/1 2/2/1 3/1/2
f -1//1 -2//2 2//1
usemtl glow
f 1 2 4 3
f 1/1 2/2 3/1
"""
MTL = b"newmtl stone\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 20 # shiny\nmap_Kd -s 1 1 1 t.png\nnewmtl glow\nKe 1 2 3\nmap_d t.png\n"
PLY_ASCII = b"""ply
format ascii 1.0
comment a square
element vertex 4
property float x
property float y
property float z
property double nx
property double ny
property double nz
property float u
property float v
element face 2
property list uchar int vertex_indices
end_header
0 0 0 0 0 1 0 0
1 0 0 0 0 1 1 0
0 1 0 0 0 0 0 1
1 1 0 0 0 1 1 1
3 0 1 2
4 0 1 3 2
"""
PLY_BINARY = (
    b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    b"element face 2\nproperty uchar flag\nproperty list uchar uint vertex_indices\nend_header\n"
    + struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    + struct.pack("<BB3IBB3I", 7, 3, 0, 1, 2, 8, 3, 2, 1, 0)
)
GLTF = json.dumps(
    {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"children": [1], "rotation": [0, 0, 0.6, 0.8], "scale": [1, -2, 3]},
            {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]},
            {"camera": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3]},
        ],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "aspectRatio": 1.5}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0, "mode": 4}]}],
        "materials": [
            {
                "name": "stone",
                "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 1], "baseColorTexture": {"index": 0}, "metallicFactor": 0.5},
                "emissiveFactor": [1, 0, 0],
                "alphaMode": "MASK",
            }
        ],
        "textures": [{"source": 0}],
        "images": [{"uri": "t.png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            {"bufferView": 0, "byteOffset": 0, "componentType": 5126, "count": 4, "type": "VEC2"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"uri": "square.bin", "byteLength": 60}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 3, "spot": {"outerConeAngle": 0.5}}]}},
    }
).encode()
SQUARE = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32).tobytes() + np.array([0, 1, 2, 2, 1, 3], np.uint16).tobytes()
GLB_TEXT = GLTF.replace(b'"uri": "square.bin", ', b"") + b" " * (-len(GLTF.replace(b'"uri": "square.bin", ', b"")) % 4)
GLB_CHUNKS = struct.pack("<II", len(GLB_TEXT), 0x4E4F534A) + GLB_TEXT + struct.pack("<II", len(SQUARE), 0x004E4942) + SQUARE
GLB = b"glTF" + struct.pack("<II", 2, 12 + len(GLB_CHUNKS)) + GLB_CHUNKS
TOML = b"""name = "room"
unit = 0.5
up = [0, 1, 0]
[[geometry]]
file = "good.obj"
transform = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]
normals = "smooth"
body = "car"
[[geometry]]
file = "good.ply"
material = "paint"
[material."*"]
specular = [0.1, 0.1, 0.1]
[material.paint]
albedo = [0.2, 0.2, 0.2]
roughness = 0.3
lobe = "ggx"
two_sided = true
transparent = false
[camera.a]
position = [0, 0, 3]
target = [0, 0, 0]
fov_x = 40
size = [64, 64]
[[light]]
type = "spot"
position = [0, 1, 0]
direction = [0, -1, 0]
intensity = [1, 1, 1]
inner = 20
outer = 25
[[light]]
type = "environment"
radiance = [1, 1, 1]
rotation = 3
"""
BESIDE = {"a.mtl": MTL, "square.bin": SQUARE, "good.obj": OBJ, "good.ply": PLY_BINARY}
TOKENS = [
    *(b"nan inf -inf 1e999 1e39 -1 0 2 99 3000000000 99999999999999999999 1.5 abc / // # \\\n".split(b" ")),
    *(b'" { } [ ] [[ ]] , : = \n \r \0 \xff \t true null "x" {} [] ../../x /etc/hostname http://x 5121 5125'.split(b" ")),
]

quickly = settings(
    max_examples=120, deadline=3000, derandomize=True, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large]
)


@st.composite
def mutated(draw: Callable, original: bytes) -> bytes:
    """`original` with a few bytes changed, cut out, repeated, or replaced by what parsers stumble over."""
    data = bytearray(original)
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, max(len(data) - 1, 0)))
        end = min(len(data), at + draw(st.integers(0, 12)))
        kind = draw(st.sampled_from(["token", "byte", "cut", "repeat", "end", "number"]))
        if kind == "token":
            data[at:end] = draw(st.sampled_from(TOKENS))
        elif kind == "byte" and data:
            data[at] = draw(st.integers(0, 255))
        elif kind == "cut":
            del data[at:end]
        elif kind == "repeat":
            data[at:at] = bytes(data[at:end]) * draw(st.integers(1, 5))
        elif kind == "end":
            del data[at:]
        else:
            digits = [k for k, letter in enumerate(data) if 48 <= letter <= 57]
            if digits:
                data[(k := draw(st.sampled_from(digits))) : k + 1] = draw(st.sampled_from(TOKENS))
    return bytes(data)


def load(name: str, data: bytes) -> Scene | None:
    """The scene of a file of those bytes, or None where that is a SceneError with a message that names a file."""
    with tempfile.TemporaryDirectory() as folder:
        base = Path(folder) / "scenes" / "room"
        base.mkdir(parents=True)
        for beside, content in BESIDE.items():
            (base / beside).write_bytes(content)
        (base / name).write_bytes(data)
        try:
            return read_scene(str(base / name))
        except SceneError as error:
            assert "room/" in str(error) and len(str(error)) < 1000
            return None


def whole(scene: Scene | None) -> bool:
    """A scene that came out is sound: finite, in range, hashable."""
    if scene is None:
        return False
    assert scene.hash and np.isfinite(scene.bounds).all()
    for mesh in scene.meshes:
        assert not len(mesh.triangles) or mesh.triangles.max() < len(mesh.positions)
    return True


def test_the_originals_load() -> None:
    for name, data in {"a.obj": OBJ, "a.ply": PLY_ASCII, "b.ply": PLY_BINARY, "a.gltf": GLTF, "a.glb": GLB, "a.toml": TOML}.items():
        if name == "a.toml":
            data += b"[material.stone]\n"
        scene = load(name, data)
        assert whole(scene) and scene is not None and scene.triangles >= 2, name


@quickly
@given(mutated(OBJ))
def test_any_obj_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.obj", data))


@quickly
@given(mutated(MTL))
def test_any_mtl_is_a_scene_or_a_scene_error(data: bytes) -> None:
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "a.mtl").write_bytes(data)
        (Path(folder) / "a.obj").write_bytes(OBJ)
        try:
            whole(read_scene(str(Path(folder) / "a.obj")))
        except SceneError as error:
            assert "a.mtl" in str(error) or "material" in str(error)


@quickly
@given(mutated(PLY_ASCII))
def test_any_ascii_ply_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.ply", data))


@quickly
@given(mutated(PLY_BINARY))
def test_any_binary_ply_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.ply", data))


@quickly
@given(mutated(GLTF))
def test_any_gltf_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.gltf", data))


@quickly
@given(mutated(GLB))
def test_any_glb_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.glb", data))


@quickly
@given(mutated(TOML))
def test_any_manifest_is_a_scene_or_a_scene_error(data: bytes) -> None:
    whole(load("a.toml", data))


@quickly
@given(st.binary(max_size=400), st.sampled_from(["a.obj", "a.ply", "a.gltf", "a.glb", "a.toml"]), st.booleans())
def test_random_bytes_are_a_scene_or_a_scene_error(data: bytes, name: str, begun: bool) -> None:
    heads = {"a.obj": b"v ", "a.ply": b"ply\nformat ascii 1.0\n", "a.gltf": b"{", "a.glb": b"glTF", "a.toml": b"name="}
    whole(load(name, (heads[name] if begun else b"") + data))
