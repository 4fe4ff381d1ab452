"""A method with history, for tests: an exponential mean of its frames, with a knob that makes it overshoot."""

from __future__ import annotations

from typing import Any

import numpy as np

import interreflect as ir
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.stages import shadow, trace_gbuffer


@method
class Remembering(Method):
    """Direct light of delta lights, blended with the last frame's: t_i = t_{i-1} + share (new - t_{i-1}) + momentum (t_{i-1} - t_{i-2})."""

    share: float = knob(default=1.0, doc="of the new frame", minimum=0.0, maximum=1.0)
    momentum: float = knob(default=0.0, doc="of the last change that goes on", minimum=0.0, maximum=1.0)
    shadow: Any = stage(default=ir.TracedShadows())

    bounces = 0

    def compose(self, view, profile):
        with profile.stage("shadow") as note:
            new = note(shadow(self.shadow, view.scene, trace_gbuffer(view.scene, view.camera, view.size), view.seed)).radiance
        if view.history is None:
            return new, np.zeros_like(new), (new, new)
        last, earlier = view.history
        shown = (last + self.share * (new - last) + self.momentum * (last - earlier)).astype(np.float32)
        return shown, np.zeros_like(shown), (shown, last)
