"""A method of three stages whose part in the error is known exactly, and real voxel cone tracing with a fault in one stage.

Importing this file makes two stages known that only tests have; worker processes import it too.
"""

from __future__ import annotations

import dataclasses
from typing import ClassVar

import numpy as np
from study_fakes import FakePrepared, frame, truth_of

from interreflect import _core
from interreflect.methods.method import method
from interreflect.methods.voxel_cone_tracing import VoxelConeTracing


@dataclasses.dataclass(frozen=True)
class Tint:
    """Multiplies light by 1 + error; each seed by another sample of a deviation of 1 over the root of the samples."""

    error: float = 0.0
    deviation: float = 0.0
    samples: int = 4
    description: ClassVar = {"params": ({"name": "error"}, {"name": "deviation"}, {"name": "samples"})}

    def replace(self, **changes):
        return dataclasses.replace(self, **changes)


@dataclasses.dataclass(frozen=True)
class ExactTint(Tint):
    """Without an error of its own."""


for stage in ("first_tint", "second_tint"):
    _core.stages[stage] = {"doc": "test only", "techniques": (ExactTint, Tint), "exact": ExactTint}


@dataclasses.dataclass(frozen=True)
class Tinted:
    """Half the picture's rows are lit through one stage, the other half through another, so that their errors add up.

    crowded: the first one's exact counterpart fails beside a second one that is not exact.
    """

    first_tint: Tint = Tint(error=0.3)
    second_tint: Tint | None = Tint(error=0.1)
    crowded: bool = False
    bounces: int | None = 1
    name = "tinted"
    own_stages = ()

    def exactly(self, stages, samples):
        return self

    def knobs(self):
        tints = {"first_tint": self.first_tint, "second_tint": self.second_tint}
        return {f"{stage}.{k}": v for stage, tint in tints.items() if tint for k, v in {"": repr(tint)}.items()} | {
            stage: None for stage, tint in tints.items() if tint is None
        } | {"crowded": self.crowded}

    def exact_knobs(self):
        return {name: tint for name, tint in (("first_tint", self.first_tint), ("second_tint", self.second_tint)) if tint}

    def replace(self, knobs):
        return dataclasses.replace(self, **knobs)

    def prepare(self, scene, threads=None):
        return TintedPrepared(self, scene)


class TintedPrepared(FakePrepared):
    def render(self, camera=None, size=None, seed=0, threads=None):
        if self.method.crowded and isinstance(self.method.first_tint, ExactTint) and not isinstance(self.method.second_tint, ExactTint):
            raise ValueError("too crowded")
        direct, indirect = truth_of(self.scene, size)
        image, half = (direct + indirect).astype(np.float64), size[1] // 2
        rows = (slice(None, half), slice(half, None))
        for index, (tint, place) in enumerate(zip((self.method.first_tint, self.method.second_tint), rows, strict=True)):
            random = np.random.default_rng([seed, index])
            noise = 0 if tint is None else tint.deviation / np.sqrt(tint.samples)
            error = -1.0 if tint is None else tint.error
            image[place] *= 1 + error + noise * random.normal(size=image[place].shape)
        return frame(direct, (image - direct).astype(np.float32), 4.0)


@method
class Planted(VoxelConeTracing):
    """Voxel cone tracing of which one stage makes twice the light, unless it is exact."""

    fault: str = ""

    def compose(self, view, profile):
        direct, indirect, *_ = super().compose(view, profile)
        guilty = bool(self.fault) and not isinstance(getattr(self, self.fault), _core.stages[self.fault]["exact"])
        wrong = np.float32(1 + guilty)
        return (direct * wrong, indirect) if self.fault == "shadow" else (direct, indirect * wrong)
