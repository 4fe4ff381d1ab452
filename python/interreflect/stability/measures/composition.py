"""What illuminance composition loses between patches and caches: light from afar, light beside a wall, light below 0."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from interreflect.frame import Image
from interreflect.stability.failure import Reading, Trial
from interreflect.stability.measures import leaks
from interreflect.stages import trace_gbuffer

Floats = NDArray[np.float64]
DIRECTIONS = 512  # over the sphere: eight bands turn 14 times at most
GRID = "place_caches.grid"  # of a light map; or place_caches itself is the grid


def leak_by_cells(trial: Trial, body: str) -> Reading:
    """As `leaks.leak_on_body`, with `trial.value` cells along every axis of the grid of caches; of a method without one, as it is."""
    knobs, cells = trial.method.knobs(), round(trial.value)
    where = next((path for path in (GRID, "place_caches") if f"{path}.nx" in knobs), None)
    changes = {} if where is None else {f"{where}.n{axis}": cells for axis in "xyz"}
    return leaks.leak_on_body(dataclasses.replace(trial, method=trial.method.replace(changes)), body)


def far_light(trial: Trial) -> Reading:
    """Mean indirect light at the nearer half of what the camera sees over the truth's, less 1: the light is beyond."""
    frame, truth = trial.render(), trial.truth()
    depth = np.asarray(trace_gbuffer(trial.scene, trial.camera, trial.size).depth)
    near = depth < np.median(depth)

    def signed(image: Image) -> float:
        return float(image[near].mean(dtype=np.float64) / truth.indirect[near].mean(dtype=np.float64)) - 1

    error, floor = signed(frame.indirect), signed(truth.halves[0] - truth.direct)
    return Reading(abs(error), frame.indirect, truth.indirect, error, abs(floor))


def negative_radiance(trial: Trial) -> Reading:
    """Negative over positive radiance that caches hold, over all caches and directions; of a method without caches in spherical
    harmonics, of its picture. Pixels alone do not show it: their light ends at 0."""
    frame = trial.render()
    caches = getattr(frame.history, "caches", None)
    if caches is None:
        return Reading(_negative(np.asarray(frame.indirect, np.float64)), frame.image)
    bands, held = caches.bands, np.float64(caches.coefficients) * np.asarray(caches.unit)[:, None]
    colours = 1 if caches.chrominance_bands not in (0, bands) else 3  # luma comes first
    mean = held[:, : colours * bands**2].reshape(len(held), colours, bands**2).mean(1)
    return Reading(_negative(mean @ harmonics(_sphere(DIRECTIONS), bands).T), frame.image)


def _negative(light: Floats) -> float:
    return float(-np.minimum(light, 0).sum() / np.maximum(light, 0).sum())


def _sphere(count: int) -> Floats:
    """(count, 3): a Fibonacci spiral, even over the sphere."""
    k = np.arange(count) + 0.5
    z, turn = 1 - 2 * k / count, np.pi * (3 - np.sqrt(5)) * k
    return np.stack((np.sqrt(1 - z * z) * np.cos(turn), np.sqrt(1 - z * z) * np.sin(turn), z), 1)


def harmonics(directions: Floats, bands: int) -> Floats:
    """(n, bands^2): real spherical harmonics of unit directions, orthonormal, without the Condon-Shortley sign; (l, m) is column
    l^2 + l + m, as in the core's math/spherical_harmonics.h."""
    from scipy.special import gammaln, lpmv

    x, y, z = directions.T
    turn, columns = np.arctan2(y, x), np.empty((len(directions), bands * bands))
    for degree in range(bands):
        for order in range(degree + 1):
            log_norm = np.log((2 * degree + 1) / (4 * np.pi)) + gammaln(degree - order + 1) - gammaln(degree + order + 1)
            along = (-1) ** order * np.exp(log_norm / 2) * lpmv(order, degree, z)
            middle = degree * degree + degree
            columns[:, middle + order] = along * (1 if order == 0 else np.sqrt(2) * np.cos(order * turn))
            if order > 0:
                columns[:, middle - order] = along * np.sqrt(2) * np.sin(order * turn)
    return columns
