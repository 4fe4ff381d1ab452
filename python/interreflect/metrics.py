"""How far is a picture from the truth? Metrics of GROUND_TRUTH.md on linear radiance, arrays of shape (height, width, 3).

Every metric takes the picture first and the reference second, computes in double precision and returns a float (`error_map`
an array). Arrays of different shapes or with numbers that are not finite are `ValueError`s; noise in the reference is
not: a metric never refuses, the records carry the reference's own noise beside it.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

__all__ = ["energy_ratio", "epsilon", "error_map", "flip", "hue_shift", "relmse", "ssim", "tone_map", "trimmed_relmse"]

Image = npt.NDArray[np.floating]

RELATIVE_EPSILON = 0.01  # of the squared mean of the reference, so that exposure does not matter
TRIMMED_SHARE = 0.001
MIDDLE_GREY = 0.18
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])  # linear sRGB, IEC 61966-2-1
CHROMA_FLOOR = 0.01  # of a pixel's largest channel: a pixel with less colour has no hue
FLIP_STOPS = 2.0  # half the range of exposures around the one that brings the reference's mean to middle grey
FLIP_EXPOSURES = 3
SSIM_SIDE = 11  # pixels: the Gaussian window of Wang et al. 2004


def epsilon(reference: Image) -> float:
    """The constant below the fraction of `relmse`: .01 (mean of the reference)^2."""
    return RELATIVE_EPSILON * float(np.mean(reference, dtype=np.float64)) ** 2


def error_map(image: Image, reference: Image) -> npt.NDArray[np.float64]:
    """Relative squared error of every pixel, (height, width); its mean is `relmse`."""
    return np.asarray(_relative_squares(*_checked(image, reference)).mean(axis=2))


def relmse(image: Image, reference: Image) -> float:
    """Relative mean squared error: mean over pixels and channels of (t - r)^2 / (r^2 + eps), eps = .01 mean(r)^2.

    Does not change when both pictures are scaled. Against an all-black reference: 0 if the picture is black too, else inf.
    """
    return float(_relative_squares(*_checked(image, reference)).mean())


def trimmed_relmse(image: Image, reference: Image) -> float:
    """`relmse` without the largest .1 % of its terms (rounded down): fireflies do not drown the rest."""
    squares = _relative_squares(*_checked(image, reference)).ravel()
    kept = squares.size - int(TRIMMED_SHARE * squares.size)
    return float(np.partition(squares, kept - 1)[:kept].mean())


def energy_ratio(image: Image, reference: Image) -> float:
    """mean(t) / mean(r): 1 where no light is lost or made.

    Against a reference of mean 0: 1 if the picture's mean is 0 too, else inf.
    """
    test, truth = _checked(image, reference)
    of_test, of_truth = float(test.mean()), float(truth.mean())
    if of_truth == 0.0:
        return 1.0 if of_test == 0.0 else math.copysign(math.inf, of_test)
    return of_test / of_truth


def hue_shift(image: Image, reference: Image) -> float:
    """Mean hue difference in degrees, 0 to 180, over the pixels that have a hue in both pictures.

    Hue is the angle of a colour in the plane across the grey axis, atan2(sqrt(3) (g - b), 2 r - g - b). A pixel has one if
    the range of its channels exceeds .01 of the largest; pictures without such pixels shift by 0.
    """
    test, truth = _checked(image, reference)
    coloured = _has_hue(test) & _has_hue(truth)
    if not coloured.any():
        return 0.0
    difference = np.abs(_hue(test[coloured]) - _hue(truth[coloured]))
    return float(np.degrees(np.minimum(difference, 2 * np.pi - difference)).mean())


def tone_map(image: Image, reference: Image) -> npt.NDArray[np.float64]:
    """The fixed tone map of `ssim` and of every chart: to [0, 1), with the reference's exposure.

    Radiance times .18 / mean(r), negative light cut off, x / (1 + x) [Reinhard et al. 2002, eq. 3], then the power 1 / 2.2.
    """
    test, truth = _checked(image, reference)
    mean = float(truth.mean())
    exposed = np.maximum(test * (MIDDLE_GREY / mean if mean > 0.0 else 1.0), 0.0)
    return np.asarray((exposed / (1.0 + exposed)) ** (1.0 / 2.2))


def ssim(image: Image, reference: Image) -> float:
    """Structural similarity [Wang et al. 2004] of the tone-mapped pictures (`tone_map`): 1 for equal ones.

    Gaussian window of standard deviation 1.5 pixels, mean over channels and pixels; both sides at least 11 pixels.
    """
    from skimage.metrics import structural_similarity

    test, truth = _checked(image, reference)
    if min(truth.shape[:2]) < SSIM_SIDE:
        raise ValueError(f"ssim needs at least {SSIM_SIDE} x {SSIM_SIDE} pixels, got {truth.shape[1]} x {truth.shape[0]}")
    return float(
        structural_similarity(  # type: ignore[no-untyped-call]
            tone_map(truth, truth),
            tone_map(test, truth),
            channel_axis=2,
            data_range=1.0,
            gaussian_weights=True,
            sigma=1.5,
            use_sample_covariance=False,
        )
    )


def flip(image: Image, reference: Image, start_exposure: float | None = None, stop_exposure: float | None = None) -> float:
    """Mean HDR-FLIP [Andersson et al. 2021] over 3 exposures, 0 (equal) to 1, at 67 pixels per degree; negative light is 0.

    Exposures are in stops and always explicit, as the automatic range of FLIP diverges with the reference's median: they run from
    `start_exposure` to `stop_exposure`. None: 2 stops below and above the exposure that brings the mean luminance of the
    reference to .18 (for a black reference, around 0 stops).
    """
    import flip_evaluator

    test, truth = _checked(image, reference)
    luminance = float((truth @ LUMINANCE).mean())
    middle = math.log2(MIDDLE_GREY / luminance) if luminance > 0.0 else 0.0
    start = middle - FLIP_STOPS if start_exposure is None else float(start_exposure)
    stop = middle + FLIP_STOPS if stop_exposure is None else float(stop_exposure)
    if not (math.isfinite(start) and math.isfinite(stop) and start <= stop):
        raise ValueError(f"flip: exposures must be finite and in order, got {start} to {stop}")
    # Scaled first, so that FLIP's single precision sees values around 1 whatever the scene's unit.
    scale = 2.0**middle
    arrays = [np.ascontiguousarray(np.clip(a * scale, 0.0, 1e9), dtype=np.float32) for a in (truth, test)]
    exposures = {"startExposure": start - middle, "stopExposure": stop - middle, "numExposures": FLIP_EXPOSURES}
    _, mean, _ = flip_evaluator.evaluate(arrays[0], arrays[1], "HDR", applyMagma=False, parameters=exposures)
    return float(mean)


def _checked(image: Image, reference: Image) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    test, truth = np.asarray(image), np.asarray(reference)
    for name, array in (("image", test), ("reference", truth)):
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise ValueError(f"{name} must have the shape (height, width, 3), got {array.shape}")
    if test.shape != truth.shape:
        raise ValueError(f"image and reference must have the same shape, got {test.shape} and {truth.shape}")
    for name, array in (("image", test), ("reference", truth)):
        wrong = array.size - np.count_nonzero(np.isfinite(array))
        if wrong:
            raise ValueError(f"{name} has {wrong} numbers that are not finite, of {array.size}")
    return test.astype(np.float64), truth.astype(np.float64)


def _relative_squares(test: npt.NDArray[np.float64], truth: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    squares = (test - truth) ** 2
    eps = epsilon(truth)
    if eps == 0.0 and not truth.any():
        return np.where(squares == 0.0, 0.0, np.inf)
    return np.asarray(squares / (truth**2 + eps))


def _has_hue(image: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    largest = image.max(axis=2)
    return np.asarray((largest > 0.0) & (largest - image.min(axis=2) > CHROMA_FLOOR * largest))


def _hue(colours: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    red, green, blue = colours[:, 0], colours[:, 1], colours[:, 2]
    return np.asarray(np.arctan2(math.sqrt(3.0) * (green - blue), 2.0 * red - green - blue))
