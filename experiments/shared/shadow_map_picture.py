"""A method whose picture is a shadow map's depth."""

from __future__ import annotations

from typing import ClassVar

import numpy as np

import interreflect as ir
from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile


@method
class ShadowMapPicture(Method):
    """Depth that the first directional light sees, red, 0 nearest to 1 farthest; the square map stands in the middle of the picture."""

    texels: int = knob(default=4096, doc="of the map along each side", unit="texels", minimum=1, maximum=16384)

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        lights = [light for light in view.scene.lights if isinstance(light, ir.PointLight | ir.SpotLight | ir.DirectionalLight)]
        number = next(i for i, light in enumerate(lights) if isinstance(light, ir.DirectionalLight))
        with profile.stage("shadow_map") as note:
            seen = note(_core.reflective_shadow_map(view.scene.core, number, self.texels))
        along = seen.position @ np.asarray(lights[number].direction, np.float32)
        met = seen.normal.any(-1)
        near, far = float(along[met].min()), float(along[met].max())
        depth = np.where(met, (along - near) / max(far - near, 1e-30), 0)
        width, height = view.size
        side = min(width, height)
        nearest = (np.arange(side) + 0.5) * self.texels / side
        shown = depth[np.ix_(nearest.astype(int), nearest.astype(int))]
        picture = np.zeros((height, width, 3), np.float32)
        top, left = (height - side) // 2, (width - side) // 2
        picture[top : top + side, left : left + side, 0] = shown
        return picture, np.zeros_like(picture)
