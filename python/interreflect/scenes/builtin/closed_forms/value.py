"""What a closed form is: a configuration whose answer is known, and how to read that answer off pictures of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.values import Scene


class Pictures(Protocol):
    """What `measure` reads of a frame: (height, width, 3) each, image = direct + indirect."""

    @property
    def image(self) -> NDArray[np.float32]: ...
    @property
    def direct(self) -> NDArray[np.float32]: ...
    @property
    def indirect(self) -> NDArray[np.float32]: ...


@dataclass(frozen=True, kw_only=True)
class ClosedForm:
    """One row of the table of closed forms, with one choice of its knobs.

    quantity: what `value` is, in words. value: the formula's number.
    scene: the configuration. cameras: names in it; one picture of `size` = (width, height) from each is what `measure` wants.
    bounces: of the light transport that the value describes (None: all). part: which of a frame's pictures holds it.
    transport: "light", or "spherical harmonics": what a method that stores light in three bands gets, not what light does.
    tolerance: largest relative error that the scene's meshes and the finite picture cause; `reason` says which. Noise adds to it.
    weights, scale, offset: value = offset + scale * sum over cameras of weight * mean of the picture.
    """

    row: int
    quantity: str
    value: float
    scene: Scene
    bounces: int | None
    part: str = "image"
    cameras: Sequence[str] = ("view",)
    weights: Sequence[float] = (1.0,)
    scale: float = 1.0
    offset: float = 0.0
    size: tuple[int, int] = (32, 32)
    transport: str = "light"
    tolerance: float = 1e-3
    reason: str

    @property
    def camera(self) -> str:
        """Name of the first camera."""
        return self.cameras[0]

    def measure(self, *frames: Pictures) -> float:
        """The value as pictures show it: one frame for each of `cameras`, rendered with `bounces`.

        Raises ValueError for another number of frames.
        """
        if len(frames) != len(self.cameras):
            raise ValueError(f"closed form {self.row} needs one frame of each of {list(self.cameras)}, got {len(frames)}")
        means = [float(np.mean(getattr(frame, self.part), dtype=np.float64)) for frame in frames]
        return self.offset + self.scale * sum(w * mean for w, mean in zip(self.weights, means, strict=True))
