"""Precomputed illuminance composition: light goes from surfels through a tree and precomputed links to caches, and to the pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods.composition_presets import PRESETS
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
from interreflect.stages import (
    cluster_surfels,
    evaluate,
    light_caches,
    link,
    place_caches,
    place_surfels,
    pull,
    shade,
    shadow,
    sky,
    surfel_pixels,
    trace_gbuffer,
)

# Without history all bounces are summed up until the surfels' light grows by less than this share of itself.
CONVERGED = 1e-3
MOST_PASSES = 256


@dataclass(frozen=True)
class CacheLight:
    """What a frame leaves to the next: the caches' light, or where pixels take it from the links what comes through them."""

    caches: _core.LightCaches | None
    patches: _core.NodeLight


@method
class IlluminanceComposition(Method):
    """Precomputed illuminance composition [Jendersie, Kuri and Grosch 2016].

    Surfels on the still surface are lit like pixels. A tree sums up what patches of them send on, and each cache, linked to a fixed number
    of patches that it sees, adds that up in spherical harmonics. Pixels interpolate between caches. Surfels, tree, caches and links are
    built once; a moved light costs a frame, a moved body receives light and sends none on. More bounces light the surfels by the caches.
    """

    bounces: int | None = knob(
        default=1, doc="most indirect bounces; None: all, one more with every frame, and until they converge in a frame without history",
        minimum=1, maximum=64, optional=True,
    )  # fmt: skip

    place_surfels: Any = stage(default=_core.HaltonSurfels())
    cluster_surfels: Any = stage(default=_core.Agglomerative())
    place_caches: Any = stage(default=_core.LightMap())
    link: Any = stage(default=_core.ShLinks())
    evaluate: Any = stage(default=_core.SphericalHarmonicLobes())
    shade: Any = stage(default=_core.Exact())
    shadow: Any = stage(default=_core.TracedShadows())
    sky: Any = stage(default=_core.TracedSky())

    preset_values = PRESETS

    def __post_init__(self) -> None:
        super().__post_init__()
        if isinstance(self.sky, _core.ConeSky):
            raise ValueError("IlluminanceComposition.sky: ConeSky needs cones, and surfels have none")
        if isinstance(self.shadow, _core.VoxelCones):
            raise ValueError("IlluminanceComposition.shadow: VoxelCones needs voxels, and surfels have none")
        if isinstance(self.evaluate, _core.DirectLinks) and isinstance(self.link, _core.AllSurfels):
            raise ValueError("IlluminanceComposition.evaluate: DirectLinks needs links, and AllSurfels stores none")
        if self.chrominance_bands > self.link.bands:
            raise ValueError(
                f"IlluminanceComposition.evaluate.chrominance_bands must lie in [0, {self.link.bands}], the bands of the links, "
                f"got {self.chrominance_bands}"
            )
        if isinstance(self.place_caches, _core.PixelCaches) and self.bounces != 1:
            raise ValueError("IlluminanceComposition.bounces: PixelCaches light pixels alone, not surfels for another bounce")

    @property
    def chrominance_bands(self) -> int:
        bands: int = getattr(self.evaluate, "chrominance_bands", 0)  # DirectLinks has no caches' light
        return bands

    def precompute(self, scene: Scene) -> dict[str, Any]:
        surfels = cluster_surfels(self.cluster_surfels, place_surfels(self.place_surfels, scene))
        state: dict[str, Any] = {"surfels": surfels, "pixels": surfel_pixels(surfels, scene)}
        if not isinstance(self.place_caches, _core.PixelCaches):
            state["sites"] = place_caches(self.place_caches, scene)
            state["links"] = link(self.link, state["sites"], surfels, scene)
        return state

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        sites, links = self.linked(view, gbuffer, profile)
        arrived = self.light(view, sites, links, profile)
        with profile.stage("evaluate") as note:
            light = note(evaluate(self.evaluate, arrived.caches, sites, gbuffer, scene, links, arrived.patches))
        with profile.stage("shadow") as note:
            direct_light = note(shadow(self.shadow, scene, gbuffer, seed))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed))
        with profile.stage("shade"):
            indirect = shade(gbuffer, light.gathered, light.glossy)
            direct = gbuffer.emission + direct_light.radiance + environment.radiance
        return direct, indirect, arrived

    def linked(self, view: View, gbuffer: _core.GBuffer, profile: Profile) -> tuple[_core.CacheSites, _core.CacheLinks | None]:
        """Caches and their links: built once, or where they stand at pixels in every frame."""
        if "sites" in view.state:
            return view.state["sites"], view.state["links"]
        with profile.stage("place_caches") as note:
            sites = note(place_caches(self.place_caches, view.scene, gbuffer))
        with profile.stage("link") as note:
            links = link(self.link, sites, view.state["surfels"], view.scene)
            if links is not None:
                note(links)
        return sites, links

    def light(self, view: View, sites: _core.CacheSites, links: _core.CacheLinks | None, profile: Profile) -> CacheLight:
        """What comes to the caches of all bounces asked for."""
        with profile.stage("light_surfels") as note:
            lit = self.light_surfels(view, note)
        last: CacheLight | None = view.history if self.bounces is None else None
        passes = self.bounces if self.bounces is not None else 1 if last is not None else MOST_PASSES
        sent = lit
        for bounce in range(passes):
            if last is not None:
                with profile.stage("light_surfels_again") as note:
                    before, sent = sent, lit + self.reflected(view, last, sites, links, note)
                if self.bounces is None and view.history is None and converged(before, sent):
                    break
            last = self.pass_on(view, sent, sites, links, bounce, profile)
        assert last is not None
        return last

    def pass_on(
        self, view: View, sent: NDArray[np.float32], sites: _core.CacheSites, links: _core.CacheLinks | None, bounce: int, profile: Profile
    ) -> CacheLight:
        """From the surfels to the caches."""
        surfels = view.state["surfels"]
        with profile.stage("pull") as note:
            patches = note(pull(surfels, sent, getattr(self.link, "pull", "flux") == "radiosity"))
        if isinstance(self.evaluate, _core.DirectLinks):
            return CacheLight(None, patches)
        with profile.stage("light_caches") as note:
            seed = (view.seed + bounce) % 2**32
            caches = note(light_caches(self.link, links, sites, surfels, patches, view.scene, self.chrominance_bands, seed))
        return CacheLight(caches, patches)

    def light_surfels(self, view: View, note: Any) -> NDArray[np.float32]:
        """(rows, columns, 3): radiance that surfels reflect of the lights'."""
        pixels = view.state["pixels"]
        lights = note(shadow(self.shadow, view.scene, pixels, view.seed))
        # Neighbours in the list of surfels are none in a picture: nothing may be filtered over them.
        environment = note(sky(self.sky.replace(filter_radius=0), view.scene, pixels, view.seed))
        radiance: NDArray[np.float32] = lights.radiance + environment.radiance
        return radiance

    def reflected(
        self, view: View, last: CacheLight, sites: _core.CacheSites, links: _core.CacheLinks | None, note: Any
    ) -> NDArray[np.float32]:
        """(rows, columns, 3): radiance that surfels reflect of the caches'."""
        pixels = view.state["pixels"]
        light = note(evaluate(self.evaluate, last.caches, sites, pixels, view.scene, links, last.patches))
        return shade(pixels, light.gathered)


def converged(before: NDArray[np.float32], after: NDArray[np.float32]) -> bool:
    """Whether light grew by less than CONVERGED of itself."""
    return float(np.abs(after - before).sum()) <= CONVERGED * float(after.sum())
