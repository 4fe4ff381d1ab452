"""Scene files for tests: written, not kept."""

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
POSITIONS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], np.float32)


def write(folder: Path, **files: str | bytes) -> Path:
    """Files named like keywords (a_obj is a.obj); the folder."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.items():
        path = folder / ".".join(name.rsplit("_", 1))
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def write_image(path: Path, pixels: np.ndarray) -> None:
    import OpenImageIO as oiio

    output = oiio.ImageOutput.create(str(path))
    kind = {"uint8": "uint8", "uint16": "uint16", "float32": "float"}[pixels.dtype.name]
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    spec.attribute("oiio:UnassociatedAlpha", 1)  # colours go into the file as they are
    assert output.open(str(path), spec)
    output.write_image(pixels)
    output.close()


def gltf(**changes: Any) -> dict[str, Any]:
    """A square of two triangles as the content of a .gltf whose buffer is square.bin; top-level keys replaced by `changes`."""
    content = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
        "buffers": [{"uri": "square.bin", "byteLength": 60}],
    }
    return {**content, **changes}


def square_buffer() -> bytes:
    return POSITIONS.tobytes() + np.array([0, 1, 2, 2, 1, 3], np.uint16).tobytes()


def write_gltf(folder: Path, **changes: Any) -> Path:
    write(folder, square_bin=square_buffer(), square_gltf=json.dumps(gltf(**changes)))
    return folder / "square.gltf"


def glb(content: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks
