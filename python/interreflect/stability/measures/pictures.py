"""Errors of indirect light against the path-traced truth: bands, holes, jumps, seams, peaks, hues, energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.frame import Image
from interreflect.stability.failure import Reading, Trial
from interreflect.stages import trace_gbuffer

Metric = Callable[[Image, Image, Trial], float]
FLAT = 0.995  # cosine between the normals of neighbours on one smooth surface (6 degrees)
NEAR = 0.05  # distance between them, as a share of their depth
DARK = 0.1  # of the truth: a pixel below it got no light to speak of


def against_truth(metric: Metric) -> Callable[[Trial], Reading]:
    """A measure that applies `metric` to the method's indirect light and the truth's; scenes must have no noise in direct light."""

    def measure(trial: Trial) -> Reading:
        frame, truth = trial.render(), trial.truth()
        half = truth.halves[0] - truth.direct  # as far from the truth as the truth is from its expectation
        floor = abs(metric(half, truth.indirect, trial))
        signed = metric(frame.indirect, truth.indirect, trial)
        return Reading(abs(signed), frame.image, truth.image, signed, floor)

    return measure


def bands(image: Image, truth: Image, trial: Trial) -> float:
    """Root mean square of the error's high frequencies (what differs from the mean of 5 x 5 on the same surface) over the truth's mean."""
    joined = _same_surface(trial)
    error = (image - truth).astype(np.float64).mean(2)
    total, count = error.copy(), np.ones_like(error)
    for (dy, dx), same in joined(2).items():
        total += np.where(same, np.roll(error, (dy, dx), (0, 1)), 0)
        count += same
    whole = count == 25
    return float(np.sqrt(((error - total / count)[whole] ** 2).mean()) / truth[whole].mean())


def holes(image: Image, truth: Image, trial: Trial) -> float:
    """Share of the pixels that indirect light reaches to which the picture gives less than a tenth of it."""
    wanted = truth.mean(2)
    reached = wanted > DARK * wanted.mean()
    return float((image.mean(2)[reached] < DARK * wanted[reached]).mean())


def jump(image: Image, truth: Image, trial: Trial) -> float:
    """Largest difference between neighbours on one surface, less the truth's own there, over the truth's mean."""
    excess = 0.0
    for (dy, dx), same in _same_surface(trial)(1).items():
        steps = [np.abs(a - np.roll(a, (dy, dx), (0, 1))).mean(2) for a in (image.astype(np.float64), truth.astype(np.float64))]
        if same.any():
            excess = max(excess, float((steps[0] - steps[1])[same].max()))
    return excess / float(truth.mean())


def seam(image: Image, truth: Image, trial: Trial) -> float:
    """Mean absolute error at pixels beside an edge between surfaces, over the truth's mean there."""
    gbuffer = trace_gbuffer(trial.scene, trial.camera, trial.size)
    smooth = np.ones(gbuffer.depth.shape, bool)
    for same in _same_surface(trial)(1).values():
        smooth &= same
    beside = ~smooth & np.isfinite(gbuffer.depth)
    beside[[0, -1]], beside[:, [0, -1]] = False, False
    return float(np.abs(image - truth)[beside].mean() / truth[beside].mean())


def peak(image: Image, truth: Image, trial: Trial) -> float:
    """Largest of the picture over the truth's largest, less 1: what is singular, or clamped (negative)."""
    return float(image.max() / truth.max() - 1)


def ringing(image: Image, truth: Image, trial: Trial) -> float:
    """Depth of negative light over the peak, or the share of negative pixels, whichever is more."""
    low = max(0.0, -float(image.min()) / max(float(image.max()), 1e-30))
    return max(low, float((image < 0).mean()))


def hue(image: Image, truth: Image, trial: Trial) -> float:
    """Mean hue difference in degrees, or 180 times the share of negative light, whichever is more; 180 for a grey or black picture."""
    if metrics.hue_shift(image, truth) == 0.0 and not np.ptp(image, axis=2).any():
        return 180.0
    return max(metrics.hue_shift(image, truth), 180 * float((image < 0).mean()))


def energy(image: Image, truth: Image, trial: Trial) -> float:
    """Energy ratio less 1; 0 where picture and truth are black."""
    return metrics.energy_ratio(image, truth) - 1


def _same_surface(trial: Trial) -> Callable[[int], dict[tuple[int, int], NDArray[np.bool_]]]:
    """reach -> (dy, dx) -> (height, width): does the neighbour that `np.roll` brings to a pixel lie on the same smooth surface?"""
    gbuffer = trace_gbuffer(trial.scene, trial.camera, trial.size)
    normal, position = np.asarray(gbuffer.geometric_normal, np.float64), np.asarray(gbuffer.position, np.float64)
    depth = np.where(np.isfinite(gbuffer.depth), gbuffer.depth, 0.0)

    def neighbours(reach: int) -> dict[tuple[int, int], NDArray[np.bool_]]:
        found = {}
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                if (dy, dx) == (0, 0):
                    continue
                there = [np.roll(a, (dy, dx), (0, 1)) for a in (normal, position, depth)]
                same = (np.einsum("hwc,hwc->hw", normal, there[0]) > FLAT ** max(abs(dy), abs(dx))) & (depth > 0) & (there[2] > 0)
                same &= np.abs(np.einsum("hwc,hwc->hw", position - there[1], normal)) < NEAR * depth
                inside = np.zeros_like(same)
                rows = slice(max(dy, 0), same.shape[0] + min(dy, 0))
                inside[rows, max(dx, 0) : same.shape[1] + min(dx, 0)] = True
                found[dy, dx] = same & inside
        return found

    return neighbours
