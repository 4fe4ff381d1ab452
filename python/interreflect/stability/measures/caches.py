"""What caches leave out, and what they blur."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from interreflect import _core
from interreflect.frame import Image
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Reading, Trial
from interreflect.stages import camera_of

FINE = 64  # texels on a side of a cache that resolves the lobes of an exponent of 1,000: 1.4 degrees each


def uncovered(trial: Trial) -> Reading:
    """Share of the pixels with a surface whose caches' weights sum up to 0; the truth is 0.

    0 for methods that interpolate nothing: each of their pixels has light of its own.
    """
    frame = trial.render()
    counts = {} if (stage := frame.profile.stages.get("interpolate")) is None else stage.counts
    without, with_one = counts.get("uncovered_pixels", 0), counts.get("covered_pixels", 0)
    return Reading(without / (without + with_one) if without else 0.0, frame.image)


def blurred(trial: Trial) -> Reading:
    """Mean change of indirect light over its mean, from the picture in which every pixel has a fine cache of its own and its lobes are
    integrated over it; the same voxels fill both.

    0 for methods that interpolate nothing. ValueError where there is no indirect light to compare with.
    """
    frame, method = trial.render(), trial.method
    if not {"fill.resolution", "preconvolve", "interpolate"} <= set(method.knobs()):
        return Reading(0.0, frame.image, frame.image)
    own = {"distribute": _core.CachePerPixel(), "preconvolve": _core.LobeIntegral(), "interpolate": _core.Evaluated()}
    fine = method.replace(own).replace({"fill.resolution": FINE})
    image, indirect = _rendered(fine, trial.scene, camera_of(trial.scene, trial.camera), trial.size, trial.seed)
    mean = float(indirect.mean(dtype=np.float64))
    if not mean > 0:
        raise ValueError("the picture has no indirect light from which blur could be read")
    return Reading(float(np.abs(frame.indirect.astype(np.float64) - indirect).mean() / mean), frame.image, image)


@lru_cache(maxsize=16)  # methods that differ in how they share caches have one truth, which takes seconds
def _rendered(method: Any, scene: Scene, camera: Camera, size: tuple[int, int], seed: int) -> tuple[Image, Image]:
    frame = method.prepare(scene).render(camera, size=size, seed=seed)
    return frame.image, frame.indirect
