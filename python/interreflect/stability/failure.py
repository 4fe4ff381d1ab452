"""A failure is a value: a scene with one knob, a metric, a truth, and the tolerance beyond which a method counts as broken."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import numpy as np

from interreflect.frame import Frame, Image
from interreflect.scenes.scene import Scene
from interreflect.stability.not_finite import NotFinite
from interreflect.study.reference import Reference, Truth, reference

TRUTH = Reference(noise=1e-4, max_spp=4096)  # of the small pictures that failures look at


@dataclasses.dataclass(frozen=True, eq=False)
class Reading:
    """What a metric read.

    error: at least 0, compared with the tolerance. signed: the same with its sign, where the metric has one. floor: what the truth's own
    noise adds to the error. image: what was looked at, truth: what it should be (None where the truth is a single number).
    """

    error: float
    image: Image
    truth: Image | None = None
    signed: float = math.nan
    floor: float = 0.0


@dataclasses.dataclass(frozen=True, eq=False)
class Trial:
    """One method on one setting of a failure: what a metric gets."""

    method: Any
    make: Callable[[float], Scene]
    value: float
    camera: str | None
    size: tuple[int, int]
    seed: int
    threads: int | None

    @property
    def scene(self) -> Scene:
        return self.make(self.value)

    def render(self, camera: str | None = None, scene: Scene | None = None, method: Any = None) -> Frame:
        """The method's frame: of the failure's camera and scene unless others are named; `method`: the same with other knobs."""
        shown, by = self.scene if scene is None else scene, self.method if method is None else method
        frame: Frame = by.prepare(shown, threads=self.threads).render(camera or self.camera, size=self.size, seed=self.seed)
        if not (np.isfinite(frame.image).all() and np.isfinite(frame.indirect).all()):
            raise NotFinite("the picture holds numbers that are not finite", frame.image)
        return frame

    def truth(self, camera: str | None = None) -> Truth:
        """The path-traced truth of the method's own bounces."""
        return reference(self.scene, camera or self.camera, self.size, self.method.bounces, TRUTH.noise, TRUTH.max_spp)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Failure:
    """One way to break.

    knob, unit: what is swept; scene: the scene at a value of the knob. easy, hard: ends of the sweep; logarithmic: even steps of its
    logarithm. measure: reads the error off a method at one setting. quantity: what the error is. truth: closed form or reference, in
    words. tolerance: largest error that passes; reason: where that number comes from. stages: whose failure it is; empty: every stage's.
    """

    name: str
    knob: str
    unit: str
    easy: float
    hard: float
    scene: Callable[[float], Scene] = dataclasses.field(repr=False)
    measure: Callable[[Trial], Reading] = dataclasses.field(repr=False)
    quantity: str
    truth: str
    tolerance: float
    reason: str
    stages: tuple[str, ...]
    logarithmic: bool = True
    camera: str | None = None
    size: tuple[int, int] = (64, 48)

    @property
    def waits(self) -> str:
        """ "waits for stage X" while none of the stages it concerns exists; else empty."""
        from interreflect import _core

        if not self.stages or any(stage in _core.stages for stage in self.stages):
            return ""
        return f"waits for stage {' or '.join(self.stages)}"

    def read(self, method: Any, value: float, seed: int = 0, threads: int | None = None) -> Reading:
        """The error of a method at one value of the knob; infinite where its picture holds numbers that are not finite."""
        try:
            return self.measure(Trial(method, self.scene, value, self.camera, self.size, seed, threads))
        except NotFinite as wrong:
            return Reading(math.inf, np.nan_to_num(wrong.image))

    def values(self, count: int) -> list[float]:
        """`count` values from the easy end to the hard one."""
        if self.logarithmic:
            return [float(v) for v in np.geomspace(self.easy, self.hard, count)]
        return [float(v) for v in np.linspace(self.easy, self.hard, count)]

    def between(self, a: float, b: float) -> float:
        """The middle of two values."""
        return math.sqrt(a * b) if self.logarithmic else (a + b) / 2

    def share(self, value: float) -> float:
        """Where a value lies on the way from easy (0) to hard (1)."""
        if self.logarithmic:
            return math.log(value / self.easy) / math.log(self.hard / self.easy)
        return (value - self.easy) / (self.hard - self.easy)

    def at(self, share: float) -> float:
        """The value at a share of that way."""
        return self.easy * (self.hard / self.easy) ** share if self.logarithmic else self.easy + share * (self.hard - self.easy)
