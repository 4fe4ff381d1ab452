"""Path tracing: the truth, and its own rival at few samples."""

from __future__ import annotations

from collections.abc import Collection
from typing import ClassVar

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import core_camera


@method
class PathTracing(Method):
    """Unbiased light transport of exactly `bounces` indirect bounces (None: all, ended by roulette), after Kajiya 1986 and Veach 1997.

    `pixel="centre"` compares with methods that shade a G-buffer; "box" is the mean over the pixel. With `milliseconds`, passes of one path
    a pixel are added until that time has gone by, whatever `spp` says; how many there were, the profile's count of paths tells.
    """

    spp: int = knob(default=16, doc="paths a pixel", minimum=1)
    milliseconds: float | None = knob(
        default=None, doc="time budget; None: `spp` decides", unit="ms", minimum=0.0, open_minimum=True, optional=True
    )
    bounces: int | None = knob(default=1, doc="indirect bounces; None: all", minimum=0, optional=True)
    pixel: str = knob(default="centre", doc="the pixel's centre, or its mean", choices=("centre", "box"))
    pattern: int = knob(
        default=4, doc="pixels at equal places of an n x n pattern share their random numbers in blocks of 4 n", minimum=1, maximum=32
    )

    own_stages: ClassVar = ("path_trace",)

    def exactly(self, stages: Collection[str], samples: int) -> PathTracing:
        return self.replace(spp=max(self.spp, samples), milliseconds=None) if stages else self

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        with profile.stage("path_trace") as note:
            traced = note(
                _core.path_trace(
                    view.scene.core,
                    core_camera(view.camera),
                    *view.size,
                    samples=self.spp if self.milliseconds is None else 2**31 - 1,
                    milliseconds=self.milliseconds,
                    bounces=self.bounces,
                    pixel=self.pixel,
                    pattern=self.pattern,
                    seed=view.seed,
                )
            )
        return traced.direct, traced.indirect
