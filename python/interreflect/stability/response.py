"""Step response: a light is switched, and a method with history follows after some frames."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import numpy as np

BAND = 0.02  # of the step: inside it, the response has settled (the usual 2 % band of control engineering)
TAIL = 0.25  # of the frames after the switch: their mean is what the method settles at


@dataclasses.dataclass(frozen=True)
class StepResponse:
    """How the picture's mean followed a switched light.

    frames: after the switch until the mean stays within 2 % of the step around the level at which it ends; None: it had not settled.
    overshoot: furthest beyond that level, as a share of the step. lag: the step's share that the switch's own frame did not show.
    """

    frames: int | None
    overshoot: float
    lag: float

    @property
    def words(self) -> str:
        settled = "had not settled" if self.frames is None else f"settled after {self.frames} frames"
        return f"{settled}, overshoot {100 * self.overshoot:.1f} %, first frame lacked {100 * self.lag:.1f} % of the step"


def response(means: Sequence[float], at: int) -> StepResponse:
    """means: of each frame's picture; the light changed before frame `at`. ValueError without frames before and four after it."""
    values = np.asarray(means, np.float64)
    if not 0 < at <= len(values) - 4:
        raise ValueError(f"a step response needs a frame before the switch and four from it on, got frame {at} of {len(values)}")
    after = values[at:]
    tail = after[-max(2, int(TAIL * len(after))) :]
    level, start = float(tail.mean()), float(values[:at].mean())
    step = level - start
    if step == 0:
        raise ValueError("the switch changed nothing: there is no step to respond to")
    rest = (after - level) / step
    outside = np.flatnonzero(np.abs(rest) > BAND)
    frames = 0 if outside.size == 0 else int(outside[-1]) + 1
    settled = frames <= len(after) - len(tail) and float(np.ptp(tail)) <= 2 * BAND * abs(step)
    return StepResponse(frames if settled else None, max(0.0, float(rest.max())), float(-rest[0]))
