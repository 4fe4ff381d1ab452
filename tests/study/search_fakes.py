"""Methods whose time and error are known functions of their knobs."""

from __future__ import annotations

import dataclasses

import numpy as np
from study_fakes import FakePrepared, frame, truth_of

from interreflect.methods.knobs import knob


@dataclasses.dataclass(frozen=True)
class Tunable:
    """Error 1/effort at a cost of effort + waste milliseconds; `idle` does nothing; an effort above 500 fails."""

    effort: float = knob(default=10.0, doc="buys accuracy", minimum=1.0, maximum=1000.0)
    waste: float = knob(default=5.0, doc="buys nothing", minimum=1.0, maximum=100.0)
    idle: float = knob(default=0.5, doc="changes nothing", minimum=0.1, maximum=1.0)
    flag: bool = knob(default=False, doc="halves the error for nothing")
    bounces: int | None = knob(default=1, doc="what is to be seen", optional=True)
    name = "tunable"

    def knobs(self):
        return dataclasses.asdict(self)

    def exact_knobs(self):
        return {}

    def replace(self, knobs):
        return dataclasses.replace(self, **knobs)

    def prepare(self, scene, threads=None):
        return TunablePrepared(self, scene)


class TunablePrepared(FakePrepared):
    def render(self, camera=None, size=None, seed=0, threads=None):
        method = self.method
        if method.effort > 500:
            raise RuntimeError("too much effort")
        direct, indirect = truth_of(self.scene, size)
        error = (0.5 if method.flag else 1.0) / method.effort * (1 + 0.01 * seed)
        pixels = size[0] * size[1] / 1e4
        return frame(direct, indirect * np.float32(1 + 4 * error), (method.effort + method.waste) * pixels)


MOODS = iter(10 ** np.random.default_rng(3).normal(0, 0.04, 10_000))


class Moody(Tunable):
    """Each of its preparations renders quicker or slower than the last, by a tenth or so."""

    def prepare(self, scene, threads=None):
        return MoodyPrepared(self, scene, precompute_milliseconds=float(next(MOODS)))


class MoodyPrepared(TunablePrepared):
    def render(self, camera=None, size=None, seed=0, threads=None):
        seen = super().render(camera, size, seed, threads)
        return frame(seen.direct, seen.indirect, seen.profile.milliseconds * self.precompute_milliseconds)
