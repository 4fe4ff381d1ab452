"""A method whose picture is one virtual light's imperfect shadow map."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from experiments.shared.light_picture import in_the_middle
from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.virtual_area_lights import VirtualAreaLights
from interreflect.methods.virtual_light_presets import PRESETS
from interreflect.profile import Profile
from interreflect.stages import join_lights, scatter_points, shadow_lights

DENSE = 2.5  # point size at which disks leave exp(-6.25), two thousandths, of a surface open


@method
class LightShadowPicture(VirtualAreaLights):
    """Radial depth in the light's map, 1 nearest to 0 farthest; empty texels are red, what is beyond the light's horizon is black.

    Counts of the stage `shadow_picture`, over all lights' maps above their horizons, against maps of `dense` times as many points, each
    drawn large enough to leave none open: `surface` and `open` texels; `holes`, empty ones of the surface; `closed`, filled ones of the
    open.
    """

    light: int = knob(default=0, doc="whose map is drawn", minimum=0, maximum=4095)
    dense: int = knob(default=20, doc="how many times as many points the maps have that tell what is open", minimum=1, maximum=1000)

    preset_values: ClassVar[Any] = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        bounced = self.lights_of_bounces(view, profile)
        lights, scene = join_lights(bounced), view.scene
        with profile.stage("shadow_lights") as note:
            depth = note(shadow_lights(self.shadow_lights, lights, scene, view.state["points"])).depth
        full = self.shadow_lights.replace(points=self.shadow_lights.points * self.dense, point_size=DENSE, iterations=0, splat="disk")
        exact = shadow_lights(full, lights, scene, scatter_points(full, scene)).depth
        above = above_horizon(depth.shape[1])
        empty, open_ = np.isinf(depth)[:, above], np.isinf(exact)[:, above]
        with profile.stage("shadow_picture") as note:
            note.counts.update(
                surface=int((~open_).sum()), open=int(open_.sum()), holes=int((empty & ~open_).sum()), closed=int((~empty & open_).sum())
            )
        picture = in_the_middle(_drawn(depth[self.light], exact[self.light], above), view.size)
        return picture, np.zeros_like(picture), None


def above_horizon(size: int) -> NDArray[np.bool_]:
    """(size, size): texels whose middle lies in the unit circle, which a paraboloid map's hemisphere fills."""
    place = (np.arange(size) + 0.5) / size * 2 - 1
    return np.asarray(place[:, None] ** 2 + place**2 <= 1)


def _drawn(depth: NDArray[np.float32], exact: NDArray[np.float32], above: NDArray[np.bool_]) -> NDArray[np.float32]:
    met = exact[above & np.isfinite(exact)]
    near, far = (float(met.min()), float(met.max())) if len(met) else (0.0, 1.0)
    grey = np.clip(1 - 0.9 * (depth - near) / max(far - near, 1e-30), 0, 1)
    picture = np.where(np.isinf(depth)[..., None], np.array([0.8, 0.1, 0.1]), np.where(np.isinf(depth), 0, grey)[..., None])
    return np.asarray(picture * above[..., None], np.float32)
