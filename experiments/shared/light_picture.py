"""A method whose picture is the lights themselves: what the light sees, where virtual lights stand and which texels they stand for."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from interreflect import _core, metrics
from interreflect.clusters import light_cluster_view
from interreflect.frame import Image
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.methods.suns import suns_of
from interreflect.methods.virtual_area_lights import VirtualAreaLights
from interreflect.methods.virtual_light_presets import PRESETS
from interreflect.profile import Profile
from interreflect.stages import cluster_lights, light_maps, sample_lights


@method
class LightPicture(VirtualAreaLights):
    """The first light's map, in the middle of the picture: `flux` that its texels send on, tone-mapped; `lights` green dots over it, before
    they are clustered where `cluster_lights` is None; `clusters` of texels each in its colour, with dots.

    Counts of the stage `picture`: `lights`; `specular_lights`, those that stand on specular materials; `texels` that send light on and
    `specular_texels`; with clusters, for every frame k `distance_k`: root of the mean square distance of a texel to its light, weighted by
    flux, in millionths of the extent of what is seen; and `moved_k`: texels that changed their light.
    """

    show: str = knob(default="clusters", doc="what is drawn", choices=("flux", "lights", "clusters"))
    frames: int = knob(default=1, doc="frames of k-means, each with the last one's lights", minimum=1, maximum=64)

    preset_values: ClassVar[Any] = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        with profile.stage("reflective_shadow_maps") as note:
            maps = note(light_maps(view.scene, self.map_size, self.emitter_views, suns_of(view, self.environment_lights)))
        lights = sample_lights(self.sample_lights, maps, view.seed)
        with profile.stage("picture") as note:
            if self.cluster_lights is not None:
                seeds, lights = lights, None
                for frame in range(self.frames):
                    last, lights = lights, cluster_lights(self.cluster_lights, seeds, maps, lights, view.seed + frame)
                    note.counts.update(_step(frame, maps.maps[0], lights, last))
            note.counts.update(_places(maps.maps[0], lights))
            flux = maps.maps[0].flux
            background = None if self.show == "clusters" else metrics.tone_map(flux, flux).astype(np.float32)
            square = np.asarray(background) if self.show == "flux" else light_cluster_view(lights, maps, background=background)
        picture = in_the_middle(square, view.size)
        return picture, np.zeros_like(picture), None


def _step(frame: int, seen: _core.ReflectiveShadowMap, lights: _core.VirtualLights, last: _core.VirtualLights | None) -> dict[str, int]:
    sends = seen.flux.max(-1) > 0
    cluster, weight, place = lights.cluster[0][sends], seen.flux[sends].sum(-1).astype(np.float64), seen.position[sends]
    squares = ((place - lights.position[cluster]) ** 2).sum(-1)
    extent = float(np.linalg.norm(np.ptp(place, axis=0)))
    counts = {f"distance_{frame}": round(1e6 * float(np.sqrt(np.average(squares, weights=weight))) / extent)}
    if last is not None:
        counts[f"moved_{frame}"] = int((last.cluster[0][sends] != cluster).sum())
    return counts


def _places(seen: _core.ReflectiveShadowMap, lights: _core.VirtualLights) -> dict[str, int]:
    specular, sends = seen.specular.max(-1).ravel() > 0, seen.flux.max(-1).ravel() > 0
    return {
        "lights": len(lights),
        "specular_lights": int(specular[lights.texel].sum()),
        "texels": int(sends.sum()),
        "specular_texels": int((specular & sends).sum()),
    }


def in_the_middle(square: NDArray[np.floating], size: tuple[int, int]) -> NDArray[np.float32]:
    """A square picture, as large as it fits by nearest texels."""
    width, height = size
    side = min(width, height)
    nearest = ((np.arange(side) + 0.5) * len(square) / side).astype(int)
    picture = np.zeros((height, width, 3), np.float32)
    top, left = (height - side) // 2, (width - side) // 2
    picture[top : top + side, left : left + side] = square[np.ix_(nearest, nearest)]
    return picture
