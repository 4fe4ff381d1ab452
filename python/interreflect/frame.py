"""A frame: what a method makes of a scene and a camera."""

from __future__ import annotations

import base64
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.profile import Profile

Image = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Frame:
    """image, direct, indirect: (height, width, 3) float32, linear radiance, image = direct + indirect.

    direct: light that reached the eye after at most one reflection, emission and sky seen directly included. history: what the next frame
    may build on, None for methods without memory.
    """

    direct: Image
    indirect: Image
    profile: Profile
    history: Any = None

    @property
    def image(self) -> Image:
        return self.direct + self.indirect

    def save(self, path: str | Path, curve: str = "srgb") -> None:
        """Writes the image: .exr and .hdr linear, anything else tone-mapped (`tone_map` by `curve`) 8 bits. OSError where it cannot."""
        from interreflect.images import write_image

        write_image(path, self.image, curve=curve)

    def _repr_html_(self) -> str:
        from interreflect.images import encode_png

        png = base64.b64encode(encode_png(self.image)).decode()
        return f'<img src="data:image/png;base64,{png}"/>{self.profile._repr_html_()}'
