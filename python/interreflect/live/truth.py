"""A truth that refines in short passes while nothing else is to be done."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

from interreflect.frame import Frame
from interreflect.methods import PathTracing
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.study.reference import Half, Truth, merged, stream_seed

PASS_SECONDS = 0.15  # of a pass, after which whoever waits gets a turn
MOST_SPP = 4096


@dataclass(eq=False)
class RefiningTruth:
    """Two independent halves of a view, as `ir.reference` has them; each pass adds as many paths a pixel to both."""

    scene: Scene
    camera: Camera
    size: tuple[int, int]
    bounces: int | None
    threads: int | None = None
    halves: tuple[Half, Half] = field(default_factory=lambda: (Half(), Half()))
    spp: int = 1  # of each half in the next pass
    latest: Truth | None = None

    @property
    def is_done(self) -> bool:
        return self.halves[0].spp + self.halves[1].spp >= MOST_SPP

    def refine(self) -> Truth:
        """One pass more. ValueError for a picture with numbers that are not finite."""
        start = time.perf_counter()
        for index, half in enumerate(self.halves):
            half.add(self._trace(stream_seed(0, index, half.rounds)), self.spp)
        spent = time.perf_counter() - start
        self.spp = min(max(1, int(self.spp * PASS_SECONDS / spent)), 2 * self.spp)
        self.latest = merged(*self.halves, key="")
        return self.latest

    def _trace(self, seed: int) -> Frame:
        tracer = PathTracing(spp=self.spp, bounces=self.bounces, pixel="centre")
        return tracer.prepare(self.scene, threads=self.threads).render(self.camera, size=self.size, seed=seed)
