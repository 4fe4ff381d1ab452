"""A method that plays a few frames and shows how much the light on the surfaces changed between them."""

from __future__ import annotations

import dataclasses

import numpy as np

from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.voxel_cone_tracing import VoxelConeTracing
from interreflect.motion import Motion
from interreflect.profile import Profile
from interreflect.stability.reprojection import origin, surfaces


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
        extent = float(np.ptp(np.asarray(view.scene.bounds), axis=0).max())
        ahead = np.subtract(view.camera.target, view.camera.position)
        step = ahead / np.linalg.norm(ahead) * self.by * extent
        name = next(name for name, camera in view.scene.cameras.items() if camera == view.camera)
        turns = Motion.rotation(name, by=self.turn, frames=self.frames)
        motion = turns if self.turn else Motion.dolly(name, by=tuple(step), frames=self.frames)
        before = None
        changes = []
        history = None
        total = np.zeros((view.size[1], view.size[0]))
        for frame in range(self.frames):
            scene, camera = motion.at(view.scene, frame)
            stages = Profile()
            _, indirect, *kept = super().compose(dataclasses.replace(view, scene=scene, camera=camera, history=history), stages)
            history = kept[0] if kept else None
            seen = surfaces(scene, camera, view.size)
            if before is not None:
                way = origin(seen, before[0])
                change = np.abs(indirect - way.fetch(before[1])).mean(2) / max(float(indirect.mean()), 1e-30)
                changes.append(change[way.found])
                total += np.where(way.found, change, 0)
            before = (seen, indirect)
        every = np.concatenate(changes)
        with profile.stage("flicker") as note:
            note.counts.update(mean=round(1e6 * every.mean()), p99=round(1e6 * np.percentile(every, 99)), points=len(every))
        picture = np.repeat((total / (self.frames - 1))[..., None], 3, axis=2).astype(np.float32)
        return picture, np.zeros_like(picture)
