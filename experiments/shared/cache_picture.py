"""A method whose picture is the caches themselves: where they stand, which pixels they serve, and what they hold."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from interreflect import _core
from interreflect.clusters import cluster_view
from interreflect.frame import Image
from interreflect.images import tone_map
from interreflect.methods.cache_presets import PRESETS
from interreflect.methods.clustered_radiance_caching import ClusteredRadianceCaching
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import distribute, fill, interpolate, preconvolve, trace_gbuffer


@method
class CachePicture(ClusteredRadianceCaching):
    """`clusters` each in its colour; `places` green dots over the albedo; `weight` each pixel's sum of weights; `maps` the radiance of
    some caches, side by side, of caches evenly spread over the list, W/(m^2 sr)."""

    show: str = knob(default="clusters", doc="what is drawn", choices=("clusters", "places", "weight", "maps"))
    maps: int = knob(default=4, doc="caches in each row where maps are drawn", minimum=1, maximum=256)

    preset_values: ClassVar[Any] = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene = view.scene
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size))
        with profile.stage("distribute") as note:
            places = note(distribute(self.distribute, gbuffer, scene))
        if self.show in ("clusters", "places"):
            background = tone_map(gbuffer.albedo) / np.float32(255) if self.show == "places" else None
            picture = cluster_view(places, background, dots=self.show == "places")
        else:
            pyramids = self.pyramids(view, profile, None)
            with profile.stage("fill") as note:
                filled = note(fill(self.fill, places, pyramids, scene, view.seed))
            if self.show == "maps":
                picture = self._side_by_side(filled, view.size)
            else:
                with profile.stage("interpolate") as note:
                    caches = preconvolve(self.preconvolve, filled)
                    light = note(interpolate(self.interpolate, caches, gbuffer, scene, pyramids, self.fill, self.preconvolve, view.seed))
                picture = np.repeat(light.weight[..., None], 3, axis=2)
        return picture, np.zeros_like(picture), None

    def _side_by_side(self, filled: _core.FilledCaches, size: tuple[int, int]) -> Image:
        """Rows of maps, as many as fit into the picture at one pixel a texel; what is left over stays black."""
        width, height = size
        n, columns = filled.resolution, self.maps
        rows = min(height // n, -(-len(filled.places) // columns))
        if columns * n > width or rows < 1:
            raise ValueError(f"a picture of {width} x {height} cannot hold {columns} maps of {n} x {n} in a row")
        chosen = np.linspace(0, len(filled.places) - 1, rows * columns).round().astype(int)
        texels = filled.texels[chosen, :, :, :3].astype(np.float32) * np.float32(filled.scale)
        picture = np.zeros((height, width, 3), np.float32)
        picture[: rows * n, : columns * n] = texels.reshape(rows, columns, n, n, 3).swapaxes(1, 2).reshape(rows * n, columns * n, 3)
        return picture
