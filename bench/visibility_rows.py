"""Hierarchy, G-buffer and sun shadows of Sponza beside Embree alone."""

from __future__ import annotations

import numpy as np

import interreflect as ir
from bench import limits
from bench.calibration import Calibration, ray_lists
from bench.rows import Row, absent, at_most_times
from bench.sponza import SIZE, Sponza
from bench.timing import least, timed
from interreflect import _core

REPEATS = 15


def rows(calibration: Calibration, sponza: Sponza | None) -> list[Row]:
    if sponza is None:
        targets = {"hierarchy, medium quality": 1.3, "G-buffer complete": 1.6, "traced sun shadows": 1.6}
        return [absent(name, f"at most {times:g}x the peer", "Sponza is not here", "Embree") for name, times in targets.items()]
    return [hierarchy(calibration, sponza), gbuffer(calibration, sponza), sun_shadows(calibration, sponza)]


def hierarchy(calibration: Calibration, sponza: Sponza) -> Row:
    meshes = sponza.scene.meshes
    masks = list({mesh.material.mask.hash: mesh.material.mask for mesh in meshes if mesh.material.mask is not None}.items())
    number = {key: k for k, (key, _) in enumerate(masks)}
    core_masks = [_core.Mask(mask.solid) for _, mask in masks]
    materials = [_core.Material(mask=-1 if m.material.mask is None else number[m.material.mask.hash]) for m in meshes]
    arrays = [(mesh.positions, mesh.triangles, mesh.normals, mesh.texcoords, k) for k, mesh in enumerate(meshes)]
    placed = [(k, sponza.scene.bodies[mesh.body] @ mesh.transform, 0) for k, mesh in enumerate(meshes)]
    geometry = _core.Geometry(arrays, placed)

    def build() -> None:
        _core.Intersector(geometry, materials, core_masks, "medium")

    ours, peer = least(timed(build), sponza.peer.build, repeats=REPEATS)
    limit = limits.hierarchy(calibration, sponza.vertices, sponza.triangles)
    return at_most_times("hierarchy, medium quality", ours, limit, "Embree, its own builder", peer, 1.3)


def gbuffer(calibration: Calibration, sponza: Sponza) -> Row:
    camera = sponza.camera
    ours, peer = least(
        timed(lambda: ir.trace_gbuffer(sponza.scene, camera, SIZE)),
        lambda: sponza.peer.primary(camera.position, camera.target, camera.up, camera.fov_x, *SIZE),
        repeats=REPEATS,
    )
    return at_most_times("G-buffer complete", ours, limits.gbuffer(calibration, sponza.pixels), "Embree, 16-wide primary rays", peer, 1.6)


def sun_shadows(calibration: Calibration, sponza: Sponza) -> Row:
    scene = sponza.scene.replace(lights=[sponza.sun])
    origins, _ = ray_lists(sponza)["sun shadow"]
    towards_sun = -np.float32(sponza.sun.direction)
    _ = scene.core
    ours, peer = least(
        timed(lambda: ir.shadow(ir.TracedShadows(), scene, sponza.gbuffer)),
        lambda: sponza.peer.shadow(origins, towards_sun),
        repeats=REPEATS,
    )
    limit = limits.sun_shadows(calibration, sponza.pixels)
    return at_most_times("traced sun shadows", ours, limit, "Embree, 16-wide shadow rays", peer, 1.6)
