"""A method whose picture is the split buffer of interleaved sampling: the pixels of each phase side by side."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import trace_gbuffer


@method
class SplitPicture(Method):
    """Shading normals, -1 to 1 as 0 to 1, of the pixels of each phase of a block in a tile of its own [Weinzierl-Heigl 2013, 6]."""

    share: Any = stage(default=_core.Interleaved(width=4, height=4))

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(view.scene, view.camera, view.size))
        colour = (0.5 + 0.5 * gbuffer.normal) * np.isfinite(gbuffer.depth)[..., None]
        picture = split(colour.astype(np.float32), self.share.width, self.share.height)
        return picture, np.zeros_like(picture)


def split(picture: NDArray[np.float32], width: int, height: int) -> NDArray[np.float32]:
    """Tile (i, j) holds the pixels (x width + i, y height + j)."""
    return np.concatenate([np.concatenate([picture[j::height, i::width] for i in range(width)], 1) for j in range(height)], 0)
