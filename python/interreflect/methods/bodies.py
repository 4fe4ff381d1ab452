"""Voxels of bodies apart from those of what stands still: made once, and moved with their bodies from then on."""

from __future__ import annotations

from typing import Any

import numpy as np

from interreflect import _core
from interreflect.methods.prepared import View
from interreflect.profile import StageClock
from interreflect.scenes.scene import WORLD, Scene
from interreflect.stages import body_domain, light_voxels, move_voxels, prefilter, voxelize


def voxelize_bodies(technique: Any, scene: Scene, voxel_size: float) -> dict[str, _core.VoxelGrid]:
    """The voxels of every body that has triangles, each in its own space; copies of a body share theirs."""
    made: dict[Any, _core.VoxelGrid] = {}
    voxels = {}
    for body in scene.bodies:
        meshes = [mesh for mesh in scene.meshes if mesh.body == body]
        if body == WORLD or not any(len(mesh.triangles) for mesh in meshes):
            continue
        look = tuple((mesh.shape_hash, mesh.material.hash, np.asarray(mesh.transform).tobytes()) for mesh in meshes)
        if look not in made:
            made[look] = voxelize(technique, scene, body_domain(scene, body, voxel_size), body=body)
        voxels[body] = made[look]
    return voxels


def parts_of(technique: Any, view: View, domain: _core.Domain, note: StageClock) -> list[_core.VoxelGrid]:
    """The voxels of what stands still, and those of every body where it is in this frame.

    Only what stands still may be voxelized here, and only when its domain is another than in the frame before.
    """
    state = view.state
    if "bodies" not in state:  # a loaded method keeps arrays only
        state["bodies"] = voxelize_bodies(technique, view.scene, domain.voxel_size)
    still = state.get("still")
    if still is None or still.domain != domain:
        still = state["still"] = note(voxelize(technique, view.scene, domain, body=WORLD))
    return [still, *(note(move_voxels(voxels, view.scene, body)) for body, voxels in state["bodies"].items())]


def lit_bodies(technique: _core.BodyCones, view: View, note: StageClock) -> list[_core.Pyramid]:
    """Of every body a hierarchy where it is in this frame, with what it reflects of direct light."""
    scene, state = view.scene, view.state
    if "bodies" not in state:
        lower, upper = np.asarray(scene.bounds)
        state["bodies"] = voxelize_bodies(_core.SurfaceSampling(), scene, float((upper - lower).max()) / technique.resolution)
    made = []
    for body, voxels in state["bodies"].items():
        lit = light_voxels(_core.TracedLighting(both_sides=True), scene, move_voxels(voxels, scene, body), view.seed)
        made.append(note(prefilter(_core.OctantCoverage(), lit)))
    return made
