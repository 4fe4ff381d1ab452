"""A scene as one file of the cache: a checksum, JSON, and the arrays as they lie in memory, so that reading copies nothing: they
stay in the file."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.camera import Camera
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, PointLight, SpotLight
from interreflect.scenes.mapped import map_file
from interreflect.scenes.material import Material
from interreflect.scenes.mesh import IDENTITY, Mesh
from interreflect.scenes.scene import Scene
from interreflect.scenes.texture import Mask, Texture

MAGIC = b"interreflect scene 1\n"
_CHECK = 32
_ALIGN = 64
_LIGHTS = {kind.__name__: kind for kind in (PointLight, SpotLight, DirectionalLight, EnvironmentLight)}


def write_scene(scene: Scene, file: IO[bytes]) -> None:
    """All of the scene but what is computed from it."""
    arrays = _Arrays()
    content = json.dumps(_as_json(scene, arrays)).encode()
    head = len(content).to_bytes(8, "little") + content
    pieces = [head, *arrays.pieces(len(MAGIC) + _CHECK + len(head))]
    check = hashlib.blake2b(digest_size=_CHECK)
    for piece in pieces:
        check.update(piece)
    file.write(MAGIC + check.digest())
    for piece in pieces:
        file.write(piece)


def array_bytes(scene: Scene) -> int:
    """About how large the scene's file is."""
    arrays = _Arrays()
    _as_json(scene, arrays)
    return sum(array.nbytes for array in arrays.items)


def read_stored(path: Path) -> Scene:
    """The scene of `write_scene`. ValueError where the file is not what was written."""
    data = map_file(path)
    body = len(MAGIC) + _CHECK
    check = hashlib.blake2b(memoryview(data)[body:], digest_size=_CHECK).digest()
    if data[: len(MAGIC)] != MAGIC or data[len(MAGIC) : body] != check:
        raise ValueError(f"{path}: damaged")
    size = int.from_bytes(data[body : body + 8], "little")
    content = json.loads(data[body + 8 : body + 8 + size])
    offset = body + 8 + size
    arrays = []
    for dtype, shape in content["arrays"]:
        offset += -offset % _ALIGN
        count = int(np.prod(shape))
        arrays.append(np.frombuffer(data, dtype, count, offset).reshape(shape))
        offset += arrays[-1].nbytes
    return _from_json(content, arrays)


class _Arrays:
    """Arrays in the order they are first asked for, each once."""

    def __init__(self) -> None:
        self.items: list[NDArray[Any]] = []
        self._numbers: dict[int, int] = {}

    def number(self, array: NDArray[Any] | None) -> int | None:
        if array is None:
            return None
        if id(array) not in self._numbers:
            self._numbers[id(array)] = len(self.items)
            self.items.append(array)
        return self._numbers[id(array)]

    def pieces(self, offset: int) -> list[bytes | memoryview]:
        result: list[bytes | memoryview] = []
        for array in self.items:
            padding = bytes(-offset % _ALIGN)
            result += [padding, array.data.cast("B") if array.size else b""]
            offset += len(padding) + array.nbytes
        return result


class _Table:
    """Values as JSON, each once by its content."""

    def __init__(self, as_json: Callable[[Any], dict[str, Any]]) -> None:
        self.rows: list[dict[str, Any]] = []
        self._as_json = as_json
        self._numbers: dict[str, int] = {}

    def number(self, value: Any, key: str | None = None) -> int | None:
        if value is None:
            return None
        key = key or value.hash
        if key not in self._numbers:
            row = self._as_json(value)  # first: it may add to other tables
            self._numbers[key] = len(self.rows)
            self.rows.append(row)
        return self._numbers[key]


def _as_json(scene: Scene, arrays: _Arrays) -> dict[str, Any]:
    images = _Table(lambda image: {"pixels": arrays.number(image.pixels), "hash": image.hash})
    masks = _Table(lambda mask: {"solid": arrays.number(mask.solid), "hash": mask.hash})
    plain = [field.name for field in fields(Material) if field.name not in ("albedo_map", "emission_map", "mask")]

    def material_row(material: Material) -> dict[str, Any]:
        maps = {"albedo_map": images.number(material.albedo_map), "emission_map": images.number(material.emission_map)}
        return {key: getattr(material, key) for key in plain} | maps | {"mask": masks.number(material.mask)}

    def shape_row(mesh: Mesh) -> dict[str, Any]:
        names = ("positions", "triangles", "normals", "texcoords")
        return {name: arrays.number(getattr(mesh, name)) for name in names} | {"shape_hash": mesh.shape_hash}

    materials, shapes = _Table(material_row), _Table(shape_row)
    meshes = [
        {
            "shape": shapes.number(mesh, mesh.shape_hash),
            "material": materials.number(mesh.material, mesh.material.hash + mesh.material.name),
            "body": mesh.body,
            "name": mesh.name,
            "transform": None if mesh.transform is IDENTITY else mesh.transform.tolist(),
        }
        for mesh in scene.meshes
    ]
    lights = []
    for light in scene.lights:
        row = {field.name: getattr(light, field.name) for field in fields(light)}
        if isinstance(light, EnvironmentLight):
            row["image"] = arrays.number(light.image)
        lights.append({"kind": type(light).__name__, **row})
    return {
        "arrays": [[array.dtype.str, array.shape] for array in arrays.items],
        "textures": images.rows,
        "masks": masks.rows,
        "materials": materials.rows,
        "shapes": shapes.rows,
        "meshes": meshes,
        "lights": lights,
        "cameras": {name: {field.name: getattr(camera, field.name) for field in fields(camera)} for name, camera in scene.cameras.items()},
        "name": scene.name,
        "up": scene.up,
        "unit": scene.unit,
        "warnings": scene.warnings,
        "hash": scene.hash,
    }


def _from_json(content: dict[str, Any], arrays: list[NDArray[Any]]) -> Scene:
    def array(number: int | None) -> Any:
        return None if number is None else arrays[number]

    def known(value: Any, **digests: str) -> Any:
        value.__dict__.update(digests)  # the checksum vouches for them
        return value

    textures = [known(Texture(array(row["pixels"])), hash=row["hash"]) for row in content["textures"]]
    masks = [known(Mask(array(row["solid"])), hash=row["hash"]) for row in content["masks"]]
    materials = []
    for row in content["materials"]:
        maps = {key: None if row[key] is None else textures[row[key]] for key in ("albedo_map", "emission_map")}
        materials.append(Material(**{**row, **maps, "mask": None if row["mask"] is None else masks[row["mask"]]}))
    shapes = []
    for row in content["shapes"]:
        shape = Mesh(array(row["positions"]), array(row["triangles"]), normals=array(row["normals"]), texcoords=array(row["texcoords"]))
        shapes.append(known(shape, shape_hash=row["shape_hash"]))
    meshes = []
    for row in content["meshes"]:
        placement = {key: row[key] for key in ("body", "name", "transform")}
        meshes.append(shapes[row["shape"]].replace(material=materials[row["material"]], **placement))
    lights = []
    for row in content["lights"]:
        kind = _LIGHTS[row.pop("kind")]
        lights.append(kind(**({**row, "image": array(row["image"])} if kind is EnvironmentLight else row)))
    cameras = {name: Camera(**row) for name, row in content["cameras"].items()}
    rest = {key: content[key] for key in ("name", "up", "unit", "warnings")}
    scene: Scene = known(Scene(meshes=meshes, lights=lights, cameras=cameras, **rest), hash=content["hash"])
    return scene
