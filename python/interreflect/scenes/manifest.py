"""scene.toml: every table and key of SCENE_FORMAT.md, with its type checked; unknown ones are refused with the nearest known one."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.camera import Camera
from interreflect.scenes.checks import matrix, nearest_name, number, shorten
from interreflect.scenes.files import MAX_MANIFEST_BYTES, Folder, read_bytes, shown
from interreflect.scenes.images import read_radiance
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, Light, PointLight, SpotLight
from interreflect.scenes.mesh import IDENTITY
from interreflect.scenes.parts import NORMALS

_TOP = ("name", "unit", "up", "geometry", "material", "camera", "light")
_GEOMETRY = ("file", "material", "transform", "normals", "body")
MATERIAL_KEYS = (
    "albedo", "albedo_map", "specular", "roughness", "exponent", "lobe", "emission", "emission_map", "mask", "two_sided", "transparent",
)  # fmt: skip
_CAMERA = ("position", "target", "up", "fov_x", "size")
_LIGHTS = {
    "directional": (DirectionalLight, ("direction", "irradiance")),
    "point": (PointLight, ("position", "intensity")),
    "spot": (SpotLight, ("position", "direction", "intensity", "inner", "outer")),
}
_ENVIRONMENT = ("type", "radiance", "file", "rotation")
MAX_KEY_PARTS = 16
# a.b.c and so on, bare or in quotes: the parser's time grows with the square of their number
_DEEP_KEY = re.compile(rb"""(?<![A-Za-z0-9_-])(?:(?:[A-Za-z0-9_-]++|"[^"\n]*+"|'[^'\n]*+')[ \t]*+\.[ \t]*+){%d}""" % MAX_KEY_PARTS)
_MAPS = ("albedo_map", "emission_map", "mask")


@dataclass(frozen=True)
class Geometry:
    """One table [[geometry]]; `where` names it in messages."""

    where: str
    file: str
    material: str | None
    transform: NDArray[np.float64]
    normals: str
    body: str


@dataclass(frozen=True)
class Manifest:
    """A scene.toml, checked; files located. materials: name -> keys, maps as paths."""

    file: str
    name: str
    unit: float
    up: Any
    geometry: list[Geometry]
    materials: dict[str, dict[str, Any]]
    cameras: dict[str, Camera]
    lights: list[Light]


def read_manifest(path: str, folder: Folder) -> Manifest:
    """Raises SceneError that names file, key and value."""
    file = shown(path)
    data = read_bytes(path, MAX_MANIFEST_BYTES)
    if _DEEP_KEY.search(data):
        raise SceneError(f"{file}: a key of more than {MAX_KEY_PARTS} parts is not read")
    try:
        top = tomllib.loads(data.decode("utf-8"))
    except (ValueError, RecursionError) as error:
        raise SceneError(f"{file}: is no TOML: {str(error)[:200]}") from None
    check_keys(f"{file}: ", top, _TOP)
    name = top.get("name", "")
    if not isinstance(name, str):
        raise SceneError(f"{file}: name must be a string, got {shorten(name)}")
    up = top.get("up", (0.0, 1.0, 0.0))
    return Manifest(
        file=file,
        name=name or path,
        unit=checked(file, lambda: number("unit", top.get("unit", 1.0), 0, open_low=True)),
        up=up,
        geometry=[_geometry(f"{file}: geometry[{k}]", table, folder) for k, table in enumerate(_tables(file, top, "geometry"))],
        materials={n: _material(f"{file}: material.{n}", t, folder) for n, t in _named_tables(file, top, "material").items()},
        cameras={n: _camera(f"{file}: camera.{n}", t, up) for n, t in _named_tables(file, top, "camera").items()},
        lights=[_light(f"{file}: light[{k}]", t, folder) for k, t in enumerate(_tables(file, top, "light"))],
    )


def checked(where: str, make: Any, separator: str = ": ") -> Any:
    """make(), its ValueError turned into a SceneError that begins with `where`."""
    try:
        return make()
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError(f"{where}{separator}{error}") from None


def check_keys(where: str, table: Mapping[str, Any], known: Iterable[str]) -> None:
    for key in table:
        if key not in known:
            raise SceneError(f"{where}{shorten(key)} is no known key{nearest_name(key, known)}")


def _tables(file: str, top: Mapping[str, Any], key: str) -> list[dict[str, Any]]:
    value = top.get(key, [])
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        raise SceneError(f"{file}: {key} must be a list of tables, [[{key}]], got {shorten(value)}")
    return value


def _named_tables(file: str, top: Mapping[str, Any], key: str) -> dict[str, dict[str, Any]]:
    value = top.get(key, {})
    if not isinstance(value, dict) or not all(isinstance(item, dict) for item in value.values()):
        raise SceneError(f"{file}: {key} must hold tables, [{key}.name], got {shorten(value)}")
    return value


def _require(where: str, table: Mapping[str, Any], keys: Iterable[str]) -> None:
    for key in keys:
        if key not in table:
            raise SceneError(f"{where}.{key} is missing")


def _geometry(where: str, table: Mapping[str, Any], folder: Folder) -> Geometry:
    check_keys(f"{where}.", table, _GEOMETRY)
    _require(where, table, ["file"])
    for key in ("material", "body"):
        if key in table and (not isinstance(table[key], str) or not table[key]):
            raise SceneError(f"{where}.{key} must be a name, got {shorten(table[key])}")
    normals = table.get("normals", "file")
    if normals not in NORMALS:
        raise SceneError(f"{where}.normals must be one of {', '.join(map(repr, NORMALS))}, got {shorten(normals)}")
    return Geometry(
        where,
        folder.require(table["file"], f"{where}.file"),
        table.get("material"),
        _transform(where, table["transform"]) if "transform" in table else IDENTITY,
        normals,
        table.get("body", "world"),
    )


def _transform(where: str, value: Any) -> NDArray[np.float64]:
    if not isinstance(value, list) or len(value) != 16:
        raise SceneError(f"{where}.transform must be 16 numbers, row by row, got {shorten(value)}")
    numbers = [checked(where, lambda x=x, k=k: number(f"transform[{k}]", x), ".") for k, x in enumerate(value)]
    result: NDArray[np.float64] = checked(where, lambda: matrix("transform", np.array(numbers).reshape(4, 4)), ".")
    return result


def _material(where: str, table: Mapping[str, Any], folder: Folder) -> dict[str, Any]:
    check_keys(f"{where}.", table, MATERIAL_KEYS)
    if "roughness" in table and "exponent" in table:
        raise SceneError(f"{where} must have only one of roughness and exponent, got {table['roughness']} and {table['exponent']}")
    for key in ("two_sided", "transparent"):
        if not isinstance(table.get(key, True), bool):
            raise SceneError(f"{where}.{key} must be true or false, got {shorten(table[key])}")
    located = {key: folder.require(table[key], f"{where}.{key}") for key in _MAPS if key in table}
    return {**table, **located}


def _camera(where: str, table: Mapping[str, Any], up: Any) -> Camera:
    check_keys(f"{where}.", table, _CAMERA)
    _require(where, table, ("position", "target", "fov_x"))
    camera: Camera = checked(where, lambda: Camera(**{"up": up, **table}), ".")
    return camera


def _light(where: str, table: Mapping[str, Any], folder: Folder) -> Light:
    kind = table.get("type")
    if kind == "environment":
        return _environment(where, table, folder)
    if not isinstance(kind, str) or kind not in _LIGHTS:
        known = [*_LIGHTS, "environment"]
        raise SceneError(f"{where}.type must be one of {', '.join(map(repr, known))}, got {shorten(kind)}")
    make, keys = _LIGHTS[kind]
    check_keys(f"{where}.", table, ("type", *keys))
    _require(where, table, keys)
    light: Light = checked(where, lambda: make(**{key: table[key] for key in keys}), ".")
    return light


def _environment(where: str, table: Mapping[str, Any], folder: Folder) -> EnvironmentLight:
    check_keys(f"{where}.", table, _ENVIRONMENT)
    if "file" not in table:
        _require(where, table, ["radiance"])
    keys = {key: table[key] for key in ("radiance", "rotation") if key in table}
    if "file" in table:
        keys["image"] = read_radiance(folder.require(table["file"], f"{where}.file"), folder)
    light: EnvironmentLight = checked(where, lambda: EnvironmentLight(**keys), ".")
    return light
