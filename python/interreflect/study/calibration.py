"""What a machine can do at most, measured, so that times of different machines compare: as multiples of their limits.

A record's limit is the time that its machine needs for the work that the record counted, at full speed: each stage's rays over the rate
of rays, steps of cones over the rate of multiply-adds, bytes of its result over the bandwidth, whichever takes longest. The ratio of
time and limit says what the machine's speed does not: how well its speed was used. Rays are those through a closed scene of 131,072
triangles; through a simpler one they are quicker, and the ratio may fall below 1.
"""

from __future__ import annotations

import dataclasses
import hashlib
import math
from collections.abc import Mapping
from typing import Any

from interreflect.study.files import canonical

CONE_STEP_OPERATIONS = 2 * (64 + 4)  # two trilinear look-ups of eight texels with four channels, and the sum's four channels


@dataclasses.dataclass(frozen=True)
class Calibration:
    """The best of a few tries each, on as many threads as the study uses."""

    read: float  # GB/s
    triad: float  # GB/s of a = b + s c, all three counted
    multiply_add: float  # GFLOP/s, single precision, two operations each
    coherent_rays: float  # million a second, nearest hits of neighbouring pixels
    incoherent_rays: float  # nearest hits after a diffuse bounce
    occlusion_rays: float  # any hit after a diffuse bounce
    vector_bytes: int
    threads: int
    processor: str

    @property
    def key(self) -> str:
        """Names this calibration in a study's folder."""
        return hashlib.sha256(canonical(dataclasses.asdict(self)).encode()).hexdigest()[:16]

    def limit_milliseconds(self, stages: Mapping[str, Mapping[str, Any]]) -> float:
        """The time of a record's stages at full speed, as far as their work is counted; NaN where none is."""
        return sum(self._stage_limit(stage["counts"], stage["bytes"]) for stage in stages.values()) or math.nan

    def _stage_limit(self, counts: Mapping[str, int], result_bytes: int) -> float:
        rays = counts.get("rays", 0) / self.coherent_rays + counts.get("shadow_rays", 0) / max(self.coherent_rays, self.occlusion_rays)
        steps = CONE_STEP_OPERATIONS * counts.get("cone_steps", 0) / self.multiply_add
        return max(1e-3 * rays, 1e-6 * steps, 1e-6 * result_bytes / self.triad)


def calibrate(threads: int | None) -> Calibration:
    """Measure this machine: half a second."""
    from interreflect import _core
    from interreflect.machine import about

    with _core.Threads(threads):
        rays = _core.ray_rates(repeats=2)
        return Calibration(
            read=_core.read_bandwidth(repeats=4),
            triad=_core.triad_bandwidth(repeats=3, mebibytes=128),
            multiply_add=_core.multiply_add_rate(repeats=5),
            coherent_rays=rays["coherent"],
            incoherent_rays=rays["incoherent"],
            occlusion_rays=rays["occlusion"],
            vector_bytes=_core.vector_bytes(),
            threads=threads or about().threads,
            processor=about().processor,
        )
