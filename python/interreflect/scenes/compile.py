"""Scene values to the compiled core's scene. What scenes share (textures, hierarchies) is built once, while any of them lives."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.scenes.digest import digest
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, PointLight, SpotLight
from interreflect.scenes.mapped import let_go
from interreflect.scenes.material import Material
from interreflect.scenes.texture import Mask, Texture

if TYPE_CHECKING:
    from interreflect.scenes.scene import Scene


@dataclass(eq=False)
class _Image:
    """A texture or mask in the core, and what it took to build it."""

    core: Any
    milliseconds: float


@dataclass(eq=False)
class _Hierarchy:
    """Geometry and ray hierarchy, and what they took to build, bodies at some pose."""

    geometry: _core.Geometry
    intersector: _core.Intersector
    milliseconds: float


@dataclass(eq=False)
class Compiled:
    """core: the core's scene. milliseconds: wall time of building its hierarchy and texture levels, also where another scene did it."""

    core: _core.Scene
    milliseconds: float
    parts: tuple[Any, ...]  # keeps alive what other scenes may share


_images: WeakValueDictionary[str, _Image] = WeakValueDictionary()
_hierarchies: WeakValueDictionary[str, _Hierarchy] = WeakValueDictionary()


def _milliseconds_since(start: float) -> float:
    return 1e3 * (time.perf_counter() - start)


def _image(value: Texture | Mask) -> _Image:
    found = _images.get(value.hash)
    if found is None:
        start = time.perf_counter()
        core = _core.Texture(value.pixels) if isinstance(value, Texture) else _core.Mask(value.solid)
        found = _images[value.hash] = _Image(core, _milliseconds_since(start))
    return found


class _Tables:
    """Materials, textures and masks of a scene, each once, numbered in order of first use."""

    def __init__(self) -> None:
        self.materials: dict[str, int] = {}
        self.core_materials: list[_core.Material] = []
        self.textures: dict[str, int] = {}
        self.masks: dict[str, int] = {}
        self.images: dict[str, list[_Image]] = {"textures": [], "masks": []}

    def _index(self, table: dict[str, int], images: list[_Image], value: Texture | Mask | None) -> int:
        if value is None:
            return -1
        if value.hash not in table:
            table[value.hash] = len(images)
            images.append(_image(value))
        return table[value.hash]

    def material(self, material: Material) -> int:
        if material.hash not in self.materials:
            self.materials[material.hash] = len(self.core_materials)
            self.core_materials.append(
                _core.Material(
                    albedo=material.albedo,
                    albedo_map=self._index(self.textures, self.images["textures"], material.albedo_map),
                    specular=material.specular,
                    roughness=0.5 if material.roughness is None else material.roughness,
                    exponent=material.exponent or 0.0,
                    lobe=material.lobe,
                    emission=material.emission,
                    emission_map=self._index(self.textures, self.images["textures"], material.emission_map),
                    mask=self._index(self.masks, self.images["masks"], material.mask),
                    two_sided=material.two_sided,
                )
            )
        return self.materials[material.hash]


def still_digest(scene: Scene) -> str:
    """Digest of all that stays when bodies move and lights change: shapes, materials, and where world meshes stand."""
    return digest("still", tuple((mesh.shape_hash, mesh.material.hash, mesh.body, mesh.transform) for mesh in scene.meshes))


def surface_digest(scene: Scene) -> str:
    """Digest of all that stays when bodies move and lights and what surfaces emit change."""
    return digest("surface", tuple((mesh.shape_hash, mesh.material.reflection_hash, mesh.body, mesh.transform) for mesh in scene.meshes))


def _instances(scene: Scene, number_of_shape: dict[tuple[str, int], int], keys: list[tuple[str, int]]) -> list[Any]:
    body_number = {name: k for k, name in enumerate(scene.bodies)}  # the world comes first
    placed: list[tuple[int, NDArray[np.float64], int]] = []
    for mesh, key in zip(scene.meshes, keys, strict=True):
        pose = np.ascontiguousarray(scene.bodies[mesh.body] @ mesh.transform, np.float64)
        placed.append((number_of_shape[key], pose, body_number[mesh.body]))
    return placed


def _moving(placed: list[Any]) -> list[Any]:
    """Those of the placements that the core keeps as instances (all but world meshes that stand once)."""
    uses = np.bincount([mesh for mesh, _, _ in placed], minlength=1)
    return [one for one in placed if one[2] != 0 or uses[one[0]] > 1]


def _build_hierarchy(scene: Scene, tables: _Tables) -> _Hierarchy:
    keys = [(mesh.shape_hash, tables.material(mesh.material)) for mesh in scene.meshes]
    number_of_shape: dict[tuple[str, int], int] = {}
    arrays: list[Any] = []
    for mesh, key in zip(scene.meshes, keys, strict=True):
        if key not in number_of_shape:
            number_of_shape[key] = len(arrays)
            arrays.append((mesh.positions, mesh.triangles, mesh.normals, mesh.texcoords, key[1]))
    placed = _instances(scene, number_of_shape, keys)
    # The core's materials count by number: emission may make two of one, or one of two.
    still = digest("hierarchy", surface_digest(scene), tuple(key[1] for key in keys))
    poses = digest("poses", tuple(scene.bodies.values()))
    same = _hierarchies.get(still + poses)
    if same is not None:
        return same
    other = next((h for key, h in list(_hierarchies.items()) if key.startswith(still)), None)
    start = time.perf_counter()
    if other is not None:
        geometry = other.geometry.moved(_moving(placed))
        built = _Hierarchy(geometry, other.intersector.moved(geometry), other.milliseconds)
    else:
        geometry = _core.Geometry(arrays, placed)
        intersector = _core.Intersector(geometry, tables.core_materials, [image.core for image in tables.images["masks"]])
        built = _Hierarchy(geometry, intersector, _milliseconds_since(start))
    _hierarchies[still + poses] = built
    return built


def rotation_about(axis: NDArray[np.float64], degrees: float) -> NDArray[np.float64]:
    """Rotation matrix about a unit axis, counter-clockwise seen against it (Rodrigues)."""
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    turned: NDArray[np.float64] = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return turned


def environment_rotation(up: Any, degrees: float) -> NDArray[np.float64]:
    """World from light (3, 3): the frame of up = +y turned the shortest way to `up`, then by `degrees` about it (SCENE_FORMAT.md)."""
    to = np.asarray(up, np.float64) / np.linalg.norm(up)
    axis = np.cross([0.0, 1.0, 0.0], to)
    length = float(np.linalg.norm(axis))
    if length > 1e-9:
        upright = rotation_about(axis / length, float(np.degrees(np.arctan2(length, to[1]))))
    else:
        upright = np.diag([1.0, np.sign(to[1]), np.sign(to[1])])
    return np.ascontiguousarray(rotation_about(to, degrees) @ upright)


def _light(light: Any) -> Any:
    if isinstance(light, PointLight):
        return _core.PointLight(light.position, light.intensity)
    if isinstance(light, SpotLight):
        return _core.SpotLight(light.position, light.direction, light.intensity, light.inner, light.outer)
    if isinstance(light, DirectionalLight):
        return _core.DirectionalLight(light.direction, light.irradiance)
    raise TypeError(f"lights must be lights, got {light!r}")


def compile_scene(scene: Scene) -> Compiled:
    """The core's scene, sharing what other living scenes have built already."""
    tables = _Tables()
    hierarchy = _build_hierarchy(scene, tables)
    environments = [light for light in scene.lights if isinstance(light, EnvironmentLight)]
    environment = None
    if environments:
        one = environments[0]
        environment = _core.Environment(one.radiance, one.image, environment_rotation(scene.up, one.rotation))
    core = _core.Scene(
        hierarchy.geometry,
        hierarchy.intersector,
        tables.core_materials,
        [image.core for image in tables.images["textures"]],
        [image.core for image in tables.images["masks"]],
        [_light(light) for light in scene.lights if not isinstance(light, EnvironmentLight)],
        environment,
    )
    let_go(mesh.positions for mesh in scene.meshes)  # the core has its own copies of all arrays
    images = [*tables.images["textures"], *tables.images["masks"]]
    return Compiled(core, hierarchy.milliseconds + sum(image.milliseconds for image in images), (hierarchy, *images))
