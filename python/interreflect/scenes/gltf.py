"""glTF 2.0, .gltf and .glb: meshes, nodes, materials, cameras, KHR_lights_punctual and KHR_materials_emissive_strength.

Photometric numbers are taken as radiometric ones (1 lm as 1 W), for lights and emission alike.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.errors import SceneError
from interreflect.scenes.camera import Camera
from interreflect.scenes.checks import nearest_name
from interreflect.scenes.files import MAX_GEOMETRY_BYTES, Folder, read_bytes, shown
from interreflect.scenes.gltf_buffers import Buffers, split_glb
from interreflect.scenes.gltf_json import Table, parse_json
from interreflect.scenes.gltf_materials import read_materials
from interreflect.scenes.lights import DirectionalLight, Light, PointLight, SpotLight
from interreflect.scenes.parts import GeometryFile, Placed, checked_part

_EXTENSIONS = ("KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_mesh_quantization")
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(path: str, folder: Folder) -> GeometryFile:
    """The default scene of the file."""
    file = shown(path)
    data = read_bytes(path, MAX_GEOMETRY_BYTES)
    text, binary = split_glb(file, data) if path.lower().endswith(".glb") else (data, None)
    root = parse_json(file, text)
    if not root.table("asset").text("version").startswith("2."):
        raise root.error("asset.version", "must be 2")
    for name in root.texts("extensionsRequired"):
        if name not in _EXTENSIONS:
            raise root.error("extensionsRequired", f"names {name[:60]!r}, which is not read{nearest_name(name, _EXTENSIONS)}")
    buffers = Buffers(root, path, folder, binary)
    geometry = GeometryFile([], [])
    materials, names = read_materials(root, path, folder, buffers, geometry.warnings)
    geometry.materials = materials
    meshes, cameras = root.tables("meshes"), root.tables("cameras")
    lights = root.table("extensions").table("KHR_lights_punctual").tables("lights")
    parts_of: dict[int, list[int]] = {}
    for node, transform in _placed_nodes(root):
        if "mesh" in node:
            k = node.whole("mesh", len(meshes))
            if k not in parts_of:
                parts_of[k] = _read_mesh(meshes[k], k, buffers, names, geometry)
            geometry.placed += [Placed(part, transform) for part in parts_of[k]]
        if "camera" in node:
            _add_camera(node, cameras, transform, geometry)
        extension = node.table("extensions").table("KHR_lights_punctual")
        if "light" in extension:
            _add_light(lights[extension.whole("light", len(lights))], transform, geometry)
    return geometry


def _placed_nodes(root: Table) -> list[tuple[Table, NDArray[np.float64]]]:
    """Every node of the scene with its (4, 4) world matrix, in order. SceneError where a node has two parents or is its own."""
    nodes, scenes = root.tables("nodes"), root.tables("scenes")
    if not scenes:
        raise root.error("scenes", "is missing: there is nothing to load")
    scene = scenes[root.whole("scene", len(scenes), 0)]
    stack = [(k, np.eye(4)) for k in reversed(scene.wholes("nodes", len(nodes)))]
    seen: set[int] = set()
    result = []
    while stack:
        k, above = stack.pop()
        if k in seen:
            raise nodes[k].error("", "has two parents or is a child of itself")
        seen.add(k)
        transform = above @ _local_matrix(nodes[k])
        if not np.isfinite(transform).all():
            raise nodes[k].error("matrix", "leads to numbers that are not finite")
        result.append((nodes[k], transform))
        stack += [(child, transform) for child in reversed(nodes[k].wholes("children", len(nodes)))]
    return result


def _local_matrix(node: Table) -> NDArray[np.float64]:
    if "matrix" in node:
        matrix = np.array(node.numbers("matrix", 16)).reshape(4, 4).T
        if not np.array_equal(matrix[3], (0, 0, 0, 1)):
            raise node.error("matrix", "must end in 0, 0, 0, 1")
        return matrix
    x, y, z, w = node.numbers("rotation", 4, [0, 0, 0, 1], -2, 2)
    length = math.sqrt(x * x + y * y + z * z + w * w)
    if length < 1e-3:
        raise node.error("rotation", "must be a unit quaternion")
    x, y, z, w = x / length, y / length, z / length, w / length
    matrix = np.eye(4)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.numbers("scale", 3, [1, 1, 1]))
    matrix[:3, 3] = node.numbers("translation", 3, [0, 0, 0])
    return matrix


def _read_mesh(mesh: Table, group: int, buffers: Buffers, names: list[str], geometry: GeometryFile) -> list[int]:
    """Adds the mesh's primitives to geometry.parts, as one group; their numbers there."""
    result = []
    for primitive in mesh.tables("primitives"):
        if primitive.whole("mode", 7, _TRIANGLES) < _TRIANGLES:
            geometry.warnings.append(f"{primitive.where} of points or lines left out")
            continue
        attributes = primitive.table("attributes")
        positions = buffers.array(attributes, "POSITION", "VEC3")
        normals = buffers.array(attributes, "NORMAL", "VEC3") if "NORMAL" in attributes else None
        texcoords = buffers.array(attributes, "TEXCOORD_0", "VEC2") if "TEXCOORD_0" in attributes else None
        for name, array in (("NORMAL", normals), ("TEXCOORD_0", texcoords)):
            if array is not None and len(array) != len(positions):
                raise attributes.error(name, f"must have a row for each of the {len(positions)} positions, got {len(array)}")
        triangles = _triangles(primitive, buffers, len(positions))
        buffers.count_rows(primitive, len(positions) + len(triangles))
        if texcoords is not None:
            texcoords = np.stack([texcoords[:, 0], 1 - texcoords[:, 1].astype(np.float64)], 1)  # glTF counts v from the top
        material = names[primitive.whole("material", len(names))] if "material" in primitive else None
        geometry.parts.append(checked_part(primitive.where, positions, triangles, normals, texcoords, material, group))
        result.append(len(geometry.parts) - 1)
    return result


def _triangles(primitive: Table, buffers: Buffers, count: int) -> NDArray[np.int64]:
    if "indices" in primitive:
        indices = buffers.array(primitive, "indices", "SCALAR")[:, 0]
        if indices.dtype.kind != "u":
            raise primitive.error("indices", "must be unsigned integers")
        corners = indices.astype(np.int64)
    else:
        corners = np.arange(count)
    mode = primitive.whole("mode", 7, _TRIANGLES)
    if mode == _TRIANGLES:
        if len(corners) % 3:
            raise primitive.error("indices", f"must be a multiple of three, got {len(corners)}")
        return corners.reshape(-1, 3)
    step = np.arange(max(len(corners) - 2, 0))
    if mode == _FAN:
        return np.stack([corners[step + 1], corners[step + 2], corners[np.zeros_like(step)]], 1)
    odd = step % 2
    return np.stack([corners[step], corners[step + 1 + odd], corners[step + 2 - odd]], 1)


def _add_camera(node: Table, cameras: list[Table], transform: NDArray[np.float64], geometry: GeometryFile) -> None:
    k = node.whole("camera", len(cameras))
    if cameras[k].text("type") != "perspective":
        geometry.warnings.append(f"{cameras[k].where} is not perspective and left out")
        return
    lens = cameras[k].table("perspective")
    aspect = lens.number("aspectRatio", 16 / 9, 1e-3, 1e3)
    half = math.tan(lens.number("yfov", ..., 1e-6, math.pi - 1e-6) / 2)
    name = node.text("name", "") or cameras[k].text("name", "") or f"camera{k}"
    name = name if name not in geometry.cameras else f"{name}#{len(geometry.cameras)}"
    position = transform[:3, 3]
    try:
        geometry.cameras[name] = Camera(
            position=tuple(position),
            target=tuple(position - _axis(transform, 2)),
            up=tuple(_axis(transform, 1)),
            fov_x=math.degrees(2 * math.atan(half * aspect)),
            size=(1280, max(1, min(16384, round(1280 / aspect)))),
        )
    except ValueError as error:
        raise SceneError(f"{cameras[k].where}.{error}") from None


def _add_light(light: Table, transform: NDArray[np.float64], geometry: GeometryFile) -> None:
    strength = light.number("intensity", 1.0, 0)
    colour = [c * strength for c in light.numbers("color", 3, [1, 1, 1], 0)]
    kind, position, direction = light.text("type"), transform[:3, 3].tolist(), (-_axis(transform, 2)).tolist()
    made: Light
    try:
        if kind == "point":
            made = PointLight(position=position, intensity=tuple(colour))  # type: ignore[arg-type]
        elif kind == "directional":
            made = DirectionalLight(direction=direction, irradiance=tuple(colour))  # type: ignore[arg-type]
        elif kind == "spot":
            cone = light.table("spot")
            made = SpotLight(
                position=position,
                direction=direction,
                intensity=tuple(colour),  # type: ignore[arg-type]
                inner=math.degrees(cone.number("innerConeAngle", 0.0, 0, math.pi / 2)),
                outer=math.degrees(cone.number("outerConeAngle", math.pi / 4, 0, math.pi / 2)),
            )
        else:
            raise light.error("type", f"must be 'point', 'spot' or 'directional', got {kind[:40]!r}")
    except SceneError:
        raise
    except ValueError as error:
        raise SceneError(f"{light.where}.{error}") from None
    geometry.lights.append(made)


def _axis(transform: NDArray[np.float64], k: int) -> NDArray[Any]:
    axis = transform[:3, k]
    length = float(np.linalg.norm(axis))
    return axis / length if length > 0 else axis
