"""Radiance caching that plays a few frames and shows how much the light on the surfaces changed between them."""

from __future__ import annotations

import numpy as np

from experiments.shared.flicker import play
from interreflect.frame import Image
from interreflect.methods.clustered_radiance_caching import ClusteredRadianceCaching
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.profile import Profile

POP = 0.1  # of the mean indirect radiance: a surface point that changes by more from one frame to the next pops


@method
class Popping(ClusteredRadianceCaching):
    """As Flicker, of caches. For scenes without gloss: what a mirror shows may change.

    Counts of the stage `popping`, in millionths of the mean indirect radiance: `mean`, `p99`, `max`; in millionths of the points: `pops`,
    those that change by more than a tenth of that mean. `points`: how many were compared. `caches`, `reused_caches`: mean over the frames,
    and over all but the first.
    """

    frames: int = knob(default=8, doc="frames that are played", minimum=2, maximum=64)
    by: float = knob(default=0.002, doc="how far the camera moves ahead a frame", unit="extents", minimum=0.0, maximum=1.0)
    turn: float = knob(default=0.0, doc="how far it turns a frame; it then does not move", unit="degrees", minimum=-45.0, maximum=45.0)

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        found = play(super().compose, view, self.frames, self.by, self.turn)
        counts = [stages.stages["distribute"].counts for stages in found.stages]
        with profile.stage("popping") as note:
            note.counts.update(
                mean=round(1e6 * found.every.mean()),
                p99=round(1e6 * np.percentile(found.every, 99)),
                max=round(1e6 * found.every.max()),
                pops=round(1e6 * (found.every > POP).mean()),
                points=len(found.every),
                caches=round(np.mean([one["caches"] for one in counts])),
                reused_caches=round(np.mean([one.get("reused_caches", 0) for one in counts[1:]])),
            )
        return found.grey(), np.zeros_like(found.grey())
