"""Our scenes in Mitsuba 3, an independent witness of light transport: all but masks, emission maps, spots and images of the sky."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import mitsuba_lobe
import numpy as np
from numpy.typing import NDArray

import interreflect as ir


def load_mitsuba() -> Any:
    """The module with its fastest variant that runs here: llvm needs LLVM 19."""
    import mitsuba as mi

    if mi.variant() is None:
        library = next(iter(sorted(Path("/usr/lib").glob("*/libLLVM.so.19.1"))), None)
        if library is not None:
            os.environ.setdefault("DRJIT_LIBLLVM_PATH", str(library))
        mi.set_variant("llvm_ad_rgb" if "DRJIT_LIBLLVM_PATH" in os.environ else "scalar_rgb")
        mitsuba_lobe.register(mi)
    return mi


def _reflectance(mi: Any, material: ir.Material, has_texcoords: bool) -> Any:
    texture = material.albedo_map if has_texcoords else None
    if texture is None:
        return {"type": "rgb", "value": [float(v) for v in material.albedo]}
    pixels = np.asarray(texture.pixels)[..., :3]
    if pixels.dtype == np.uint8:
        s = pixels.astype(np.float64) / 255
        pixels = np.where(s <= 0.04045, s / 12.92, ((s + 0.055) / 1.055) ** 2.4)
    data = np.ascontiguousarray(pixels * np.asarray(material.albedo), np.float32)
    return mi.load_dict({"type": "bitmap", "data": mi.TensorXf(data), "raw": True, "wrap_mode": "repeat", "filter_type": "bilinear"})


def _bsdf(mi: Any, material: ir.Material, has_texcoords: bool) -> Any:
    if material.emission_map is not None or material.mask is not None:
        raise ValueError(f"material {material.name!r} has an emission map or a mask, which this witness leaves out")
    reflectance = _reflectance(mi, material, has_texcoords)
    made: dict[str, Any] = {"type": "diffuse", "reflectance": reflectance}
    if max(material.specular) > 0:
        n, roughness = material.exponent, 0.5 if material.roughness is None else material.roughness
        alpha = roughness**2 if n is None else (2 / (n + 2)) ** 0.5
        specular = {f"specular_{c}": float(v) for c, v in zip("rgb", material.specular, strict=True)}
        texture = mi.load_dict(reflectance) if isinstance(reflectance, dict) else reflectance
        made = {"type": "scene_format_lobe", "albedo": texture, "lobe": material.lobe, "alpha": alpha, "exponent": n or 0.0, **specular}
    return mi.load_dict({"type": "twosided", "bsdf": made} if material.two_sided else made)


def _mesh(mi: Any, scene: ir.Scene, mesh: ir.Mesh, name: str, bsdfs: dict[Any, Any]) -> Any:
    properties = mi.Properties()
    key = mesh.material.hash, mesh.texcoords is not None
    if key not in bsdfs:
        bsdfs[key] = _bsdf(mi, mesh.material, mesh.texcoords is not None)
    properties["bsdf"] = bsdfs[key]
    if mesh.material.emits:
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": {"type": "rgb", "value": list(mesh.material.emission)}})
    if mesh.normals is None:
        properties["face_normals"] = True
    placed = scene.bodies[mesh.body] @ mesh.transform
    positions = mesh.positions @ placed[:3, :3].T + placed[:3, 3]
    made = mi.Mesh(
        name,
        len(positions),
        len(mesh.triangles),
        props=properties,
        has_vertex_normals=mesh.normals is not None,
        has_vertex_texcoords=mesh.texcoords is not None,
    )
    values = mi.traverse(made)
    values["vertex_positions"], values["faces"] = np.ravel(positions).astype(np.float32), np.ravel(mesh.triangles)
    if mesh.normals is not None:
        values["vertex_normals"] = np.ravel(mesh.normals @ np.linalg.inv(placed[:3, :3])).astype(np.float32)
    if mesh.texcoords is not None:
        flipped = np.stack([mesh.texcoords[:, 0], 1 - mesh.texcoords[:, 1]], 1)  # Mitsuba's v = 0 is the top row
        values["vertex_texcoords"] = np.ravel(flipped)
    values.update()
    return made


def _light(light: Any) -> dict[str, Any]:
    def rgb(value: Any) -> dict[str, Any]:
        return {"type": "rgb", "value": [float(v) for v in value]}

    if isinstance(light, ir.PointLight):
        return {"type": "point", "position": list(light.position), "intensity": rgb(light.intensity)}
    if isinstance(light, ir.DirectionalLight):
        return {"type": "directional", "direction": list(light.direction), "irradiance": rgb(light.irradiance)}
    if isinstance(light, ir.EnvironmentLight) and light.image is None:
        return {"type": "constant", "radiance": rgb(light.radiance)}
    raise ValueError(f"{light!r} is a light that this witness leaves out")


def to_mitsuba(scene: ir.Scene, camera: ir.Camera, size: tuple[int, int]) -> Any:
    """The scene seen by `camera`, box filter."""
    mi = load_mitsuba()
    bsdfs: dict[Any, Any] = {}
    film = {
        "type": "hdrfilm",
        "width": size[0],
        "height": size[1],
        "rfilter": {"type": "box"},
        "pixel_format": "rgb",
        "component_format": "float32",
    }
    place = mi.ScalarTransform4f().look_at(origin=list(camera.position), target=list(camera.target), up=list(camera.up))
    extent = float(np.ptp(scene.bounds, axis=0).max())
    made: dict[str, Any] = {
        "type": "scene",
        "sensor": {
            "type": "perspective",
            "fov": camera.fov_x,
            "fov_axis": "x",
            "to_world": place,
            "film": film,
            "near_clip": 1e-4 * extent,
            "far_clip": 1e4 * extent,
            "sampler": {"type": "independent"},
        },
    }
    for k, mesh in enumerate(scene.meshes):
        if len(mesh.triangles):
            made[f"mesh{k}"] = _mesh(mi, scene, mesh, f"mesh{k}", bsdfs)
    for k, light in enumerate(scene.lights):
        made[f"light{k}"] = _light(light)
    return mi.load_dict(made)


def render(scene: Any, bounces: int | None, spp: int, seed: int) -> NDArray[np.float32]:
    """All light up to `bounces` indirect bounces. Mitsuba counts path edges: two more."""
    mi = load_mitsuba()
    edges = {"max_depth": -1, "rr_depth": 5} if bounces is None else {"max_depth": bounces + 2, "rr_depth": 1000}
    integrator = mi.load_dict({"type": "path", **edges})
    return np.array(mi.render(scene, integrator=integrator, spp=spp, seed=seed))


def diffuse(scene: ir.Scene) -> ir.Scene:
    """The scene without lobes, cut-outs and smooth normals, which Mitsuba shades otherwise below the horizon."""
    plain = [
        ir.Mesh(
            m.positions,
            m.triangles,
            texcoords=m.texcoords,
            material=m.material.replace(specular=(0, 0, 0), mask=None),
            body=m.body,
            transform=m.transform,
        )
        for m in scene.meshes
    ]
    bodies = {name: pose for name, pose in scene.bodies.items() if name != "world"}
    return ir.Scene(meshes=plain, lights=scene.lights, cameras=scene.cameras, name=scene.name, bodies=bodies)
