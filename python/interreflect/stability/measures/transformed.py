"""Pictures that must not change, and rooms whose light is known however extreme the material."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Reading, Trial


def change(still: Scene) -> Callable[[Trial], Reading]:
    """Mean absolute difference to the picture of `still` with the same seed, over its mean."""

    def measure(trial: Trial) -> Reading:
        frame, before = trial.render(), trial.render(scene=still)
        difference = np.abs(frame.image.astype(np.float64) - before.image).mean() / before.image.mean(dtype=np.float64)
        return Reading(float(difference), frame.image, before.image)

    return measure


def furnace_energy(trial: Trial) -> Reading:
    """Energy ratio less 1 in a closed room of emission 1 and albedo `value`: sum of albedo^k up to the method's last reflection."""
    frame = trial.render()
    rho, bounces = trial.value, trial.method.bounces
    truth = 1 / (1 - rho) if bounces is None else (1 - rho ** (bounces + 2)) / (1 - rho)
    signed = float(frame.image.mean(dtype=np.float64)) / truth - 1
    return Reading(abs(signed), frame.image, np.full_like(frame.image, truth), signed)
