"""A manifest and what its files hold, put together as a Scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.checks import nearest_name
from interreflect.scenes.files import EXTENSIONS, Folder, shown
from interreflect.scenes.gltf import read_gltf
from interreflect.scenes.images import read_mask, read_texture
from interreflect.scenes.manifest import Geometry, Manifest, checked
from interreflect.scenes.material import Material
from interreflect.scenes.mesh import IDENTITY, Mesh
from interreflect.scenes.obj import read_obj
from interreflect.scenes.parts import GeometryFile, Part, cleaned
from interreflect.scenes.ply import read_ply
from interreflect.scenes.scene import Scene

_MAPS = ("albedo_map", "emission_map", "mask")


def assembled(manifest: Manifest, folder: Folder) -> Scene:
    """The scene; SceneError where a material is undefined or unused, or a value out of range."""
    builder = _Builder(manifest, folder)
    for geometry in manifest.geometry:
        builder.add(geometry)
    for name in manifest.materials:
        if name != "*" and name not in builder.used:
            hint = nearest_name(name, builder.used) if builder.used else ""
            raise SceneError(f"{manifest.file}: material.{name} is used by no geometry{hint}")
    return checked(  # type: ignore[no-any-return]
        manifest.file,
        lambda: Scene(
            meshes=builder.meshes,
            lights=[*manifest.lights, *builder.lights],
            cameras={**builder.cameras, **manifest.cameras} if not manifest.cameras else {**manifest.cameras, **builder.cameras},
            name=manifest.name,
            up=manifest.up,
            unit=manifest.unit,
            warnings=[*folder.warnings, *builder.dropped_maps()],
        ),
    )


@dataclass
class _Builder:
    manifest: Manifest
    folder: Folder
    meshes: list[Mesh] = field(default_factory=list)
    lights: list[Any] = field(default_factory=list)
    cameras: dict[str, Any] = field(default_factory=dict)
    used: set[str] = field(default_factory=set)
    _files: dict[str, GeometryFile] = field(default_factory=dict)
    _cleaned: dict[tuple[str, str], list[Part]] = field(default_factory=dict)
    _shapes: dict[tuple[str, str, int], Mesh] = field(default_factory=dict)
    _images: dict[tuple[str, str], Any] = field(default_factory=dict)
    _materials: dict[tuple[str, str | None, bool], Material | None] = field(default_factory=dict)
    _without_texcoords: dict[str, int] = field(default_factory=dict)

    def add(self, geometry: Geometry) -> None:
        """The meshes of one [[geometry]] table."""
        file = self._file(geometry)
        key = geometry.file, geometry.normals
        if key not in self._cleaned:
            self._cleaned[key] = cleaned(shown(geometry.file), file.parts, geometry.normals, self.folder.warnings)
        parts = self._cleaned[key]
        for placed in file.placed:
            part = parts[placed.part]
            name = geometry.material if geometry.material is not None else part.material
            material = self._material(geometry, file, name, part.texcoords is not None)
            if material is None or not len(part.triangles):
                continue
            shape = self._shape((*key, placed.part), part)
            self.meshes.append(_placed(geometry, shape, geometry.transform @ placed.transform, material))

    def _file(self, geometry: Geometry) -> GeometryFile:
        if geometry.file not in self._files:
            self._files[geometry.file] = file = read_geometry(geometry.file, self.folder)
            self.folder.warnings += file.warnings
        file = self._files[geometry.file]
        self.lights += [_moved_light(light, geometry) for light in file.lights]
        for name, camera in file.cameras.items():
            free = name if name not in self.cameras and name not in self.manifest.cameras else f"{shown(geometry.file)}:{name}"
            self.cameras[free] = _moved_camera(camera, geometry)
        return file

    def _shape(self, key: tuple[str, str, int], part: Part) -> Mesh:
        """The part as a mesh, made once and then shared."""
        if key not in self._shapes:
            where = f"{shown(key[0])}: "
            self._shapes[key] = checked(
                where, lambda: Mesh(part.positions, part.triangles, normals=part.normals, texcoords=part.texcoords), ""
            )
        return self._shapes[key]

    def _material(self, geometry: Geometry, file: GeometryFile, name: str | None, has_texcoords: bool) -> Material | None:
        """The material of that name; None where it is transparent."""
        key = geometry.file, name, has_texcoords
        if key in self._materials:
            return self._materials[key]
        own, over = file.materials, self.manifest.materials
        keys: dict[str, Any] = {}
        if name is not None:
            self.used.add(name)
            if name not in own and name not in over:
                known = [n for n in (*own, *over) if n != "*"]
                hint = nearest_name(name, known) if known else ""
                where = f"{shown(geometry.file)}: material" if geometry.material is None else f"{geometry.where}.material"
                raise SceneError(f"{where} {name!r} is not defined{hint}")
            keys = _merged(keys, own.get(name, {}))
        keys = _merged(keys, over.get("*", {}))
        if name is not None:
            keys = _merged(keys, over.get(name, {}))
        material = None if keys.pop("transparent", False) else self._made(geometry, keys, name, has_texcoords)
        self._materials[key] = material
        return material

    def _made(self, geometry: Geometry, keys: dict[str, Any], name: str | None, has_texcoords: bool) -> Material:
        maps = [key for key in _MAPS if key in keys]
        if maps and not has_texcoords:
            self._without_texcoords[f"{shown(geometry.file)}: material {name!r}"] = len(maps)
            keys = {key: value for key, value in keys.items() if key not in maps}
        else:
            for key in maps:
                keys[key] = self._image(key, keys[key])
        defined = name in self.manifest.materials or "*" in self.manifest.materials
        where = f"{self.manifest.file}: material.{name}" if defined else f"{shown(geometry.file)}: material {name!r}"
        material: Material = checked(where, lambda: Material(**keys, name=name or ""), ".")
        return material

    def _image(self, key: str, value: Any) -> Any:
        """A texture or mask of that file, read once; values pass."""
        if not isinstance(value, str):
            return value
        kind = "mask" if key == "mask" else "texture"
        if (kind, value) not in self._images:
            self._images[kind, value] = read_mask(value, self.folder) if kind == "mask" else read_texture(value, self.folder)
        return self._images[kind, value]

    def dropped_maps(self) -> list[str]:
        return [f"{where}: {count} maps dropped for want of texture coordinates" for where, count in self._without_texcoords.items()]


def read_geometry(path: str, folder: Folder) -> GeometryFile:
    """The file by its extension."""
    extension = path[path.rfind(".") :].lower()
    if extension == ".obj":
        return read_obj(path, folder)
    if extension == ".ply":
        return read_ply(path)
    if extension in (".gltf", ".glb"):
        return read_gltf(path, folder)
    raise SceneError(f"{shown(path)}: must be one of {', '.join(EXTENSIONS)}, got {extension!r}")


def _merged(keys: Mapping[str, Any], over: Mapping[str, Any]) -> dict[str, Any]:
    """`keys` with those of `over`; an exponent takes the place of a roughness, a roughness that of an exponent and its lobe."""
    replaced: tuple[str, ...] = ()
    if over.get("exponent") is not None:
        replaced = ("roughness",)
    elif over.get("roughness") is not None:
        replaced = ("exponent", "lobe")
    return {**{key: value for key, value in keys.items() if key not in replaced}, **over}


def _placed(geometry: Geometry, shape: Mesh, transform: NDArray[np.float64], material: Material) -> Mesh:
    still = np.array_equal(transform, IDENTITY)
    mesh: Mesh = checked(
        geometry.where,
        lambda: shape.replace(material=material, body=geometry.body, name=shown(geometry.file), transform=None if still else transform),
        ".",
    )
    return mesh


def _moved_light(light: Any, geometry: Geometry) -> Any:
    """A file's light under its table's transform; intensities stay."""
    if geometry.transform is IDENTITY:
        return light
    moved: dict[str, Any] = {}
    if hasattr(light, "position"):
        moved["position"] = (geometry.transform @ [*light.position, 1])[:3]
    if hasattr(light, "direction"):
        moved["direction"] = geometry.transform[:3, :3] @ light.direction
    return checked(geometry.where, lambda: replace(light, **moved), ".")


def _moved_camera(camera: Any, geometry: Geometry) -> Any:
    if geometry.transform is IDENTITY:
        return camera
    points = {key: (geometry.transform @ [*getattr(camera, key), 1])[:3] for key in ("position", "target")}
    return checked(geometry.where, lambda: replace(camera, **points, up=geometry.transform[:3, :3] @ camera.up), ".")
