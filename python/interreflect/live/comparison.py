"""A picture against the truth so far: its errors, and both beside each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.frame import Frame, Image
from interreflect.live.layers import light
from interreflect.study.reference import Truth

Bytes = NDArray[np.uint8]
COMPARISONS = ("method", "truth", "error map", "half and half")
OF_LIGHT = ("image", "direct", "indirect")


@dataclass(frozen=True)
class Flip:
    """HDR-FLIP of a frame's layer against a truth of so many paths a pixel. It takes longer than a frame, so it is measured at times."""

    frame: Frame
    layer: str
    spp: int
    value: float

    def holds(self, frame: Frame, layer: str, spp: int) -> bool:
        """Whether the truth has not got twice the paths since."""
        return self.frame is frame and self.layer == layer and self.spp <= spp < 2 * self.spp


@dataclass(frozen=True, eq=False)
class Errors:
    """map: (height, width), relative squared error; relmse is its mean. noise: the truth's own relMSE, and `spp` its paths a pixel."""

    map: NDArray[np.float64]
    relmse: float
    noise: float
    spp: int
    flip: Flip | None


def compare(frame: Frame, truth: Truth, layer: str, flip: Flip | None) -> Errors:
    """ValueError for a picture with numbers that are not finite. flip: the last that was measured."""
    error = metrics.error_map(light_of(frame, layer), light_of(truth, layer))
    noise = truth.indirect_noise if layer == "indirect" else truth.noise
    known = flip if flip is not None and flip.frame is frame and flip.layer == layer else None
    return Errors(error, float(error.mean()), noise, truth.spp, known)


def measure_flip(frame: Frame, truth: Truth, layer: str) -> Flip:
    return Flip(frame, layer, truth.spp, metrics.flip(light_of(frame, layer), light_of(truth, layer)))


def compared(drawn: Bytes, errors: Errors, truth: Truth, layer: str, comparison: str, stops: float) -> Bytes:
    """The picture that `comparison` asks for. drawn: the method's."""
    if comparison == "method":
        return drawn
    if comparison == "error map":
        return _error_colours(errors.map)
    pixels = light(light_of(truth, layer), stops)
    if comparison == "half and half":
        half = pixels.shape[1] // 2
        pixels[:, half:] = drawn[:, half:]
        pixels[:, half] = 255
    return pixels


def light_of(lit: Any, layer: str) -> Image:
    """Of a frame or a truth the light that a layer shows; of other layers the image."""
    found: Image = getattr(lit, layer if layer in OF_LIGHT else "image")
    return found


def _error_colours(error: NDArray[np.float64]) -> Bytes:
    from matplotlib import colormaps

    from interreflect.study.page.pictures import error_levels

    coloured: Bytes = np.round(255 * colormaps["magma"](error_levels(error))[..., :3]).astype(np.uint8)
    return coloured
