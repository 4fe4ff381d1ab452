"""Images on surfaces: colours (`Texture`) and cut-outs (`Mask`)."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.checks import locked
from interreflect.scenes.content import Content
from interreflect.scenes.digest import digest

MAX_PIXELS = 2**26  # 8192 x 8192


def _image(argument: str, value: ArrayLike, dimensions: int) -> NDArray[Any]:
    array = np.asarray(value)
    if array.ndim != dimensions or min(array.shape[:2]) < 1:
        wanted = "(height, width, 3)" if dimensions == 3 else "(height, width)"
        raise ValueError(f"{argument} must have shape {wanted} with at least one pixel, got {array.shape}")
    if array.shape[0] * array.shape[1] > MAX_PIXELS:
        raise ValueError(f"{argument} must have at most {MAX_PIXELS} pixels, got {array.shape[1]} x {array.shape[0]}")
    return array


def linear_image(argument: str, value: ArrayLike) -> NDArray[np.float32]:
    """(height, width, 3) float32, read-only, finite and not negative."""
    given = _image(argument, value, 3)
    if given.shape[2] != 3 or given.dtype.kind != "f":
        raise ValueError(f"{argument} must be (height, width, 3) float, got {given.shape} {given.dtype}")
    array: NDArray[np.float32] = locked(given, np.float32)
    # the smallest and largest number are NaN where any is
    if not (float(array.min()) >= 0 and float(array.max()) < np.inf):
        row, column, _ = np.argwhere(~(np.isfinite(array) & (array >= 0)))[0]
        raise ValueError(f"{argument}[{row}, {column}] must be finite and not negative, got {array[row, column].tolist()}")
    return array


@dataclass(frozen=True, eq=False)
class Texture(Content):
    """Colours over texture coordinates, repeated in both directions; row 0 is the top row, v = 0 the bottom one.

    pixels: (height, width, 3) uint8, sRGB, decoded at lookup; or float (height, width, 3), linear and not negative.
    Raises ValueError for another shape or dtype, non-finite or negative numbers, and more than 2^26 pixels.
    """

    pixels: NDArray[Any] = field(repr=False)

    def __post_init__(self) -> None:
        given = _image("pixels", self.pixels, 3)
        if given.dtype == np.uint8:
            if given.shape[2] != 3:
                raise ValueError(f"pixels must have three channels, got {given.shape[2]}")
            array = locked(given, np.uint8)
        elif given.dtype.kind == "f":
            array = linear_image("pixels", given)
        else:
            raise ValueError(f"pixels must be uint8 (sRGB) or float (linear), got dtype {given.dtype}")
        object.__setattr__(self, "pixels", array)

    def _digest(self) -> str:
        return digest("texture", self.pixels)


@dataclass(frozen=True, eq=False)
class Mask(Content):
    """Where a surface is solid, over texture coordinates; nearest texel, repeated, row 0 is the top row.

    solid: (height, width) bool. Raises ValueError for another shape or dtype.
    """

    solid: NDArray[np.bool_] = field(repr=False)

    def __post_init__(self) -> None:
        given = _image("solid", self.solid, 2)
        if given.dtype != np.bool_:
            raise ValueError(f"solid must hold booleans, got dtype {given.dtype}")
        object.__setattr__(self, "solid", locked(given, np.bool_))

    def _digest(self) -> str:
        return digest("mask", self.solid)
