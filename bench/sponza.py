"""The scene that most rows are measured on, with Embree's own hierarchy over the same triangles."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

import interreflect as ir

PATH = "sponza_crytek/scene.toml"
SIZE = (1280, 720)


@dataclasses.dataclass(frozen=True)
class Sponza:
    scene: ir.Scene
    peer: Any  # _peers.EmbreePeer
    gbuffer: Any
    triangles: int
    vertices: int

    @property
    def camera(self) -> ir.Camera:
        return self.scene.cameras["nave"]

    @property
    def sun(self) -> ir.DirectionalLight:
        return next(light for light in self.scene.lights if isinstance(light, ir.DirectionalLight))

    @property
    def pixels(self) -> int:
        return SIZE[0] * SIZE[1]


def load(peers: Any) -> Sponza | None:
    """Sponza, or None where its files are not there."""
    try:
        scene = ir.load_scene(PATH)
    except FileNotFoundError:
        return None
    positions, triangles = soup(scene)
    gbuffer = ir.trace_gbuffer(scene, "nave", SIZE)
    return Sponza(scene, peers.EmbreePeer(positions, triangles), gbuffer, len(triangles), len(positions))


def soup(scene: ir.Scene) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """All triangles of a scene in world space as one mesh: positions (n, 3), indices (m, 3)."""
    positions, triangles, count = [], [], 0
    for mesh in scene.meshes:
        place = scene.bodies[mesh.body] @ mesh.transform
        positions.append((mesh.positions @ place[:3, :3].T + place[:3, 3]).astype(np.float32))
        triangles.append(mesh.triangles + np.uint32(count))
        count += len(mesh.positions)
    return np.concatenate(positions), np.concatenate(triangles)


def as_peers_render_it(scene: ir.Scene) -> ir.Scene:
    """Sponza as the path tracers were compared: flat normals, textured two-sided diffuse without cut-outs, a low sun, a constant sky."""
    meshes = [
        ir.Mesh(
            m.positions, m.triangles, texcoords=m.texcoords, name=m.name,
            material=ir.Material(albedo=m.material.albedo, albedo_map=m.material.albedo_map, name=m.material.name),
        )
        for m in scene.meshes
    ]  # fmt: skip
    sun = ir.DirectionalLight(direction=(-0.2, -0.655, -0.2), irradiance=(100, 100, 100))
    sky = ir.EnvironmentLight(radiance=(5, 5, 5))
    return ir.Scene(meshes=meshes, lights=[sun, sky], cameras={"nave": scene.cameras["nave"]}, name="Sponza, diffuse", up=scene.up)
