"""Stages of voxels and cones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from interreflect import _core
from interreflect.scenes.camera import Camera, checked_size
from interreflect.scenes.scene import Scene
from interreflect.stages.view import camera_of, core_camera


def place(grid: _core.Grid, scene: Scene, camera: Camera | str | None = None, size: tuple[int, int] | None = None) -> _core.Domain:
    """The domain of a grid. Warps, cascades and some regions need the camera (None: the scene's first), view volumes the picture's
    size too (None: the camera's). ValueError for a box without extent, far not beyond near, cascades with a warp."""
    view = camera_of(scene, camera) if camera is not None or scene.cameras else None
    if view is None:
        return _core.place(grid, scene.core)
    width, height = view.size if size is None else checked_size(size)
    return _core.place(grid, scene.core, core_camera(view), width / height)


def _number_of(scene: Scene, body: str) -> int:
    """As the core numbers bodies: the world is 0. ValueError names those there are."""
    if body not in scene.bodies:
        raise ValueError(f"scene {scene.name!r} has no body {body!r}; it has {', '.join(scene.bodies)}")
    return list(scene.bodies).index(body)


def body_domain(scene: Scene, body: str, voxel_size: float) -> _core.Domain:
    """Evenly spread voxels about a body in its own space, where its pose is the identity; the outermost ones are air.

    Voxels are larger than asked for where that would take more than 1024 of them. ValueError for a body without triangles."""
    _number_of(scene, body)
    boxes = [box for mesh in scene.meshes if mesh.body == body and (box := mesh.bounds(mesh.transform)) is not None]
    if not boxes:
        raise ValueError(f"body {body!r} of scene {scene.name!r} has no triangles")
    lower, upper = np.min([box[0] for box in boxes], 0), np.max([box[1] for box in boxes], 0)
    size = max(voxel_size, float((upper - lower).max()) / 1021)
    # At least half a voxel and the whole one around it lie between the surface and each face.
    cells = np.ceil((upper - lower) / size - 1e-3).astype(int) + 3
    corner = 0.5 * (lower + upper) - 0.5 * size * cells
    return _core.Domain(lower=tuple(corner), voxel_size=size, cells=tuple(int(n) for n in cells))


def voxelize(technique: Any, scene: Scene, domain: _core.Domain, body: str | None = None) -> _core.VoxelGrid:
    """Which cells the scene's surface passes through, and what it looks like there.

    body: only that body's surface, in its own space, where the domain must lie too; "world": only that of what stands still."""
    if body is None:
        return _core.voxelize(technique, scene.core, domain)
    return _core.voxelize(technique, scene.core, domain, _number_of(scene, body), scene.bodies[body])


def move_voxels(voxels: _core.VoxelGrid, scene: Scene, body: str) -> _core.VoxelGrid:
    """A body's voxels where the scene has that body: nothing is voxelized anew. They may be a copy's, of which `body` is another."""
    return voxels.moved(_number_of(scene, body), scene.bodies[body])


def light_voxels(
    technique: Any, scene: Scene, voxels: _core.VoxelGrid, seed: int = 0, history: Any = None, others: Sequence[_core.VoxelGrid] = ()
) -> _core.LitVoxels:
    """The radiance that each voxel reflects. history: what `light_history` kept of the last frame, for BlendHistory and Bounces.
    others: voxels of the scene's other parts, through which ConeLighting's cones pass too."""
    return _core.light_voxels(technique, scene.core, voxels, seed, history, list(others))


def holds_all_bounces(technique: Any) -> bool:
    """Whether voxels lit by this technique come to hold light of all bounces, from frame to frame."""
    held = technique.light_voxels if isinstance(technique, _core.BlendHistory) else technique
    return isinstance(held, _core.Bounces)


def light_history(technique: Any, pyramid: _core.Pyramid) -> Any:
    """What `light_voxels` wants of this frame in the next one: the pyramid for Bounces, its voxels for BlendHistory, else None."""
    if holds_all_bounces(technique):
        return pyramid
    return pyramid.lit if isinstance(technique, _core.BlendHistory) else None


def prefilter(technique: Any, lit: _core.LitVoxels) -> _core.Pyramid:
    """Radiance and opacity of ever larger voxels."""
    return _core.prefilter(technique, lit)


def _several(pyramids: _core.Pyramid | Sequence[_core.Pyramid]) -> list[_core.Pyramid]:
    return [pyramids] if isinstance(pyramids, _core.Pyramid) else list(pyramids)


def march(
    technique: Any,
    pyramids: _core.Pyramid | Sequence[_core.Pyramid],
    gbuffer: _core.GBuffer,
    scene: Scene,
    share: Any = None,
    seed: int = 0,
) -> _core.GatheredLight:
    """Light that arrives at the pixels over the hemisphere: `.irradiance` from voxels, `.sky` from the environment, `.occlusion`.

    pyramids: the scene's voxels, or those of its parts: of what stands still and of bodies, where they are. What a cone sees in
    each is put in order by how far away it is [Rehfeld et al. 2014, 3.1]."""
    return _core.march(technique, _several(pyramids), gbuffer, scene.core, _core.EveryPixel() if share is None else share, seed)


def glossy(
    technique: Any, pyramids: _core.Pyramid | Sequence[_core.Pyramid], gbuffer: _core.GBuffer, scene: Scene, seed: int = 0
) -> _core.GlossyLight:
    """Light that the glossy lobe reflects towards the camera: `.radiance` from voxels, `.sky` from the environment. pyramids: as
    `march` takes them."""
    return _core.glossy(technique, _several(pyramids), gbuffer, scene.core, seed)
