"""Materials of a glTF file in the terms of SCENE_FORMAT.md."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from interreflect.scenes.files import Folder
from interreflect.scenes.gltf_buffers import Buffers, embedded
from interreflect.scenes.gltf_json import Table
from interreflect.scenes.images import read_alpha_mask, read_texture
from interreflect.scenes.texture import Mask, Texture


def read_materials(
    root: Table, path: str, folder: Folder, buffers: Buffers, warnings: list[str]
) -> tuple[dict[str, dict[str, Any]], list[str]]:
    """Material name -> keys, with textures read, and the names in the file's order."""
    images = Images(root, path, folder, buffers, warnings)
    materials: dict[str, dict[str, Any]] = {}
    names = []
    for k, table in enumerate(root.tables("materials")):
        name = table.text("name", "") or f"material{k}"
        name = name if name not in materials else f"{name}#{k}"
        names.append(name)
        materials[name] = _material(table, name, images, warnings)
    return materials, names


def _material(table: Table, name: str, images: Images, warnings: list[str]) -> dict[str, Any]:
    surface = table.table("pbrMetallicRoughness")
    *base, alpha = surface.numbers("baseColorFactor", 4, [1, 1, 1, 1], 0, 1)
    metallic = 0.0 if "metallicRoughnessTexture" in surface else surface.number("metallicFactor", 1.0, 0, 1)
    keys: dict[str, Any] = {
        "albedo": [c * (1 - metallic) for c in base],
        "specular": [0.04 + (c - 0.04) * metallic for c in base],
        "roughness": surface.number("roughnessFactor", 1.0, 0, 1),
        "emission": table.numbers("emissiveFactor", 3, [0, 0, 0], 0),
    }
    strength = table.table("extensions").table("KHR_materials_emissive_strength").number("emissiveStrength", 1.0, 0)
    keys["emission"] = [c * strength for c in keys["emission"]]
    images.set_map(keys, "albedo_map", surface, "baseColorTexture")
    images.set_map(keys, "emission_map", table, "emissiveTexture")
    mode = table.text("alphaMode", "OPAQUE")
    if mode == "MASK" and "baseColorTexture" in surface:
        cutoff = table.number("alphaCutoff", 0.5)
        threshold = cutoff / alpha if alpha > 0 else np.inf
        mask = images.mask(surface, "baseColorTexture", threshold)
        if mask is not None:
            keys["mask"] = mask
    elif mode == "BLEND":
        warnings.append(f"{table.file}: material {name!r} blends, which is not supported: it is opaque")
    return keys


class Images:
    """Textures by their place in the file, each read once."""

    def __init__(self, root: Table, path: str, folder: Folder, buffers: Buffers, warnings: list[str]) -> None:
        self._textures, self._images = root.tables("textures"), root.tables("images")
        self._path, self._folder, self._buffers, self._warnings = path, folder, buffers, warnings
        self._read: dict[int, Texture | None] = {}
        self._masks: dict[tuple[int, float], Mask | None] = {}

    def set_map(self, keys: dict[str, Any], key: str, table: Table, name: str) -> None:
        """keys[key] = the texture that table[name] refers to, where there is one."""
        k = self._image(table, name)
        if k is None:
            return
        if k not in self._read:
            self._read[k] = self._with_file(k, lambda file: read_texture(file, self._folder))
        texture = self._read[k]
        if texture is not None:
            keys[key] = texture

    def mask(self, table: Table, name: str, threshold: float) -> Mask | None:
        """The cut-out of the alpha channel of that texture; None where it has none."""
        k = self._image(table, name)
        if k is None:
            return None
        if (k, threshold) not in self._masks:
            self._masks[k, threshold] = self._with_file(k, lambda file: read_alpha_mask(file, self._folder, threshold))
        return self._masks[k, threshold]

    def _image(self, table: Table, name: str) -> int | None:
        """Number of the image that table[name] refers to."""
        if name not in table:
            return None
        reference = table.table(name)
        if reference.whole("texCoord", 2**16, 0) != 0 or "KHR_texture_transform" in reference.table("extensions"):
            self._warnings.append(f"{table.file}: {reference.path[:-1]} uses other texture coordinates, which are not read")
        texture = self._textures[reference.whole("index", len(self._textures))]
        return texture.whole("source", len(self._images)) if "source" in texture else None

    def _with_file(self, k: int, read: Any) -> Any:
        """read(file) of image k; None and a warning where there is no such file."""
        table = self._images[k]
        if "uri" in table and not table.text("uri").startswith("data:"):
            name = unquote(table.text("uri"))
            where = f"{table.file}: {table.path}uri"
            found = self._folder.locate(name, where, self._path)
            if found is None:
                self._warnings.append(f"{where} {name[:80]!r} does not exist; loaded as without it")
                return None
            return read(found)
        data = embedded(table, table.text("uri")) if "uri" in table else self._buffers.view_bytes(table, "bufferView")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / ("image.png" if data.startswith(b"\x89PNG") else "image.jpg")
            file.write_bytes(data)
            return read(str(file))
