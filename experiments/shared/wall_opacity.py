"""A method that looks along an axis through every level of a pyramid: how opaque is the wall across it there?"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import light_voxels, place, prefilter, voxelize


@method
class WallOpacity(Method):
    """Opacity along z of the levels from the finest on, over the inner half of the domain across x and y.

    Counts of the stage `prefilter`, in millionths: `level_0`, `level_1`, ...: 1 - product of (1 - opacity) along z, mean over columns.
    """

    grid: _core.Grid = _core.Grid(resolution=64)
    voxelize: Any = stage(default=_core.ExactOverlap())
    light_voxels: Any = stage(default=_core.TracedLighting())
    prefilter: Any = stage(default=_core.VolumeCoverage())
    levels: int = knob(default=5, doc="levels that are looked through, the finest included", minimum=1, maximum=10)

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        voxels = voxelize(self.voxelize, view.scene, place(self.grid, view.scene, view.camera, view.size))
        lit = light_voxels(self.light_voxels, view.scene, voxels, view.seed)
        with profile.stage("prefilter") as note:
            pyramid = note(prefilter(self.prefilter, lit))
            for level in range(min(self.levels, pyramid.levels)):
                note.counts[f"level_{level}"] = round(1e6 * opacity_along_z(pyramid.level(level)[..., 3]))
        picture = np.zeros((view.size[1], view.size[0], 3), np.float32)
        return picture, picture


def opacity_along_z(opacity: NDArray[np.floating]) -> float:
    """Of a level (z, y, x): mean over the columns of its inner half."""
    _, rows, columns = opacity.shape
    inner = opacity[:, rows // 4 : rows - rows // 4, columns // 4 : columns - columns // 4]
    return float((1 - np.prod(1 - inner, axis=0)).mean())
