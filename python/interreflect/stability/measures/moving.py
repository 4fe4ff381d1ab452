"""Temporal error as a failure's metric."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from interreflect.motion import Motion
from interreflect.stability.failure import Reading, Trial
from interreflect.stability.temporal import motion
from interreflect.study.reference import Reference

TRUTH = Reference(noise=2e-4, max_spp=2048)


def temporal(step: Callable[[float], Motion], statistic: str) -> Callable[[Trial], Reading]:
    """A measure that plays a motion whose step is the knob, and takes the mean, p95, p99 or maximum of the temporal error.

    The picture is the last frame.
    """

    def measure(trial: Trial) -> Reading:
        moving = dataclasses.replace(step(trial.value), camera=trial.camera)
        played = motion(trial.method, trial.scene, moving, trial.size, trial.seed, trial.threads, TRUTH)
        return Reading(getattr(played, statistic), played.images[-1], played.truths[-1], floor=getattr(played.truth_jumps, statistic))

    return measure


def flux_drift(step: Callable[[float], Motion]) -> Callable[[Trial], Reading]:
    """Largest change of the picture's energy ratio from frame to frame."""

    def measure(trial: Trial) -> Reading:
        moving = dataclasses.replace(step(trial.value), camera=trial.camera)
        played = motion(trial.method, trial.scene, moving, trial.size, trial.seed, trial.threads, TRUTH)
        drift = float(np.abs(np.diff(played.table["energy_ratio"])).max())
        noise = float(np.sqrt(2 * max(played.noises) / np.size(played.truths[0][..., 0])))
        return Reading(drift, played.images[-1], played.truths[-1], floor=noise)

    return measure
