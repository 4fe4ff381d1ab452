"""A method that plays a few frames and shows how much the light on the surfaces changed between them."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_cone_tracing import VoxelConeTracing
from interreflect.motion import Motion
from interreflect.profile import Profile
from interreflect.stability.reprojection import origin, surfaces

Floats = NDArray[np.float64]


@dataclasses.dataclass(frozen=True)
class Changes:
    """Indirect light's changes between frames at the same surface points, in units of the mean indirect radiance. every: of all points
    and frames. picture: (height, width), the mean over frames; 0 where nothing was seen before. stages: every frame's own profile."""

    every: Floats
    picture: Floats
    stages: list[Profile]

    def grey(self) -> Image:
        return np.repeat(self.picture[..., None], 3, axis=2).astype(np.float32)


def ahead(view: View, by: float) -> tuple[float, ...]:
    """A step along the view, in extents of the scene."""
    extent = float(np.ptp(np.asarray(view.scene.bounds), axis=0).max())
    direction = np.subtract(view.camera.target, view.camera.position)
    return tuple(direction / np.linalg.norm(direction) * by * extent)


def play(compose: Callable[[View, Profile], Any], view: View, frames: int, by: float, turn: float) -> Changes:
    """A camera that turns by `turn` degrees a frame or, where that is 0, moves `by` extents ahead, in a still scene; history passed on."""
    name = next(name for name, camera in view.scene.cameras.items() if camera == view.camera)
    motion = Motion.rotation(name, by=turn, frames=frames) if turn else Motion.dolly(name, by=ahead(view, by), frames=frames)  # type: ignore[arg-type]
    before, history = None, None
    changes, stages = [], []
    total = np.zeros((view.size[1], view.size[0]))
    for frame in range(frames):
        scene, camera = motion.at(view.scene, frame)
        stages.append(Profile())
        _, indirect, *kept = compose(dataclasses.replace(view, scene=scene, camera=camera, history=history), stages[-1])
        history = kept[0] if kept else None
        seen = surfaces(scene, camera, view.size)
        if before is not None:
            way = origin(seen, before[0])
            change = np.abs(indirect - way.fetch(before[1])).mean(2) / max(float(indirect.mean()), 1e-30)
            changes.append(change[way.found])
            total += np.where(way.found, change, 0)
        before = (seen, indirect)
    return Changes(np.concatenate(changes), total / (frames - 1), stages)


@method
class Flicker(VoxelConeTracing):
    """Indirect light's change between frames of a camera that moves ahead or turns in a still scene, at the same surface points.

    Diffuse indirect light of a still scene does not change at a surface point, so whatever changes is flicker. Picture: the mean over
    frames of |change|, in units of the mean indirect radiance, grey. Counts of the stage `flicker`, in millionths of that mean: `mean`,
    `p99`; `points`: how many were compared.
    """

    frames: int = knob(default=6, doc="frames that are played", minimum=2, maximum=64)
    by: float = knob(default=0.002, doc="how far the camera moves ahead a frame", unit="extents", minimum=0.0, maximum=1.0)
    turn: float = knob(default=0.0, doc="how far it turns a frame; it then does not move", unit="degrees", minimum=-45.0, maximum=45.0)

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        found = play(super().compose, view, self.frames, self.by, self.turn)
        with profile.stage("flicker") as note:
            note.counts.update(
                mean=round(1e6 * found.every.mean()), p99=round(1e6 * np.percentile(found.every, 99)), points=len(found.every)
            )
        return found.grey(), np.zeros_like(found.grey())
