"""Precomputed illuminance composition: light goes from surfels through a tree and precomputed links to caches, and to the pixels."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.frame import Image
from interreflect.methods import composition_pieces
from interreflect.methods.bodies import lit_bodies
from interreflect.methods.composition_presets import PRESETS
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
from interreflect.stages import (
    evaluate,
    lamp_shadow,
    light_caches,
    link,
    place_caches,
    pull,
    shade,
    shadow,
    shadow_maps,
    sky,
    surfel_pixels,
    trace_gbuffer,
    used_caches,
)

# Without history all bounces are summed up until the surfels' light grows by less than this share of itself.
CONVERGED = 1e-3
MOST_PASSES = 256


@dataclass(frozen=True)
class Caches:
    """Where caches stand, and what they are linked to: None where nothing is stored."""

    sites: _core.CacheSites
    links: _core.CacheLinks | _core.LinkCandidates | None
    used: NDArray[np.uint8] | None = None  # which of them the frame's pixels read; None: all of them


@dataclass(frozen=True)
class CacheLight:
    """What comes to caches, or where pixels take it from the links what comes through them. A frame leaves its surfels' to the next."""

    caches: _core.LightCaches | None
    patches: _core.NodeLight
    links: _core.CacheLinks | None  # that it came through


@method
class IlluminanceComposition(Method):
    """Precomputed illuminance composition [Jendersie, Kuri and Grosch 2016].

    Surfels on the still surface are lit like pixels. A tree sums up what patches of them send on, and each cache, linked to a fixed number
    of patches that it sees, adds that up in spherical harmonics. Pixels interpolate between caches. Surfels, tree, caches and links are
    built once; a moved light costs a frame. A moved body receives light, and with `shadow_links=BodyCones()` blocks that of links and sends
    its own. More bounces light the surfels by the caches.
    """

    bounces: int | None = knob(
        default=1, doc="most indirect bounces; None: all, one more with every frame, and until they converge in a frame without history",
        minimum=1, maximum=64, optional=True,
    )  # fmt: skip

    emitters: str = knob(
        default="rays", choices=("rays", "links"),
        doc="how the light of emitting surfaces comes to pixels and surfels: by the shadow stage, or from their surfels through links",
    )  # fmt: skip

    lit_caches: str = knob(
        default="all", choices=("all", "read"), doc="all caches, or those alone that the frame's pixels, or surfels of another bounce, read"
    )  # fmt: skip

    patch_light: str = knob(
        default="floats", choices=("floats", "shared exponent"),
        doc="how patches' light is kept from the pull on: 12 bytes each, or 4, nine bits a colour and one exponent for them",
    )  # fmt: skip

    place_surfels: Any = stage(default=_core.HaltonSurfels())
    cluster_surfels: Any = stage(default=_core.Agglomerative())
    place_caches: Any = stage(default=_core.LightMap())
    link: Any = stage(default=_core.ShLinks())
    shadow_links: Any = stage(default=None, optional=True)
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
        if self.lit_caches == "read" and self.bounces is None:
            raise ValueError("IlluminanceComposition.lit_caches: 'read' needs a number of bounces")
        if self.shadow_links is not None:
            self._check_shadow_links()
        if self.chrominance_bands > self.link.bands:
            raise ValueError(
                f"IlluminanceComposition.evaluate.chrominance_bands must lie in [0, {self.link.bands}], the bands of the links, "
                f"got {self.chrominance_bands}"
            )

    def _check_shadow_links(self) -> None:
        for name, technique, why in (
            ("link", _core.AllSurfels, "whose rays meet bodies themselves"),
            ("place_caches", _core.PixelCaches, "whose links' rays meet bodies themselves"),
            ("evaluate", _core.DirectLinks, "which takes no light of caches, where bodies' shadows are"),
        ):
            if isinstance(getattr(self, name), technique):
                raise ValueError(f"IlluminanceComposition.shadow_links does not go with {technique.__name__}, {why}")
        if isinstance(self.link, _core.ShLinks) and self.link.bands < 2:
            raise ValueError("IlluminanceComposition.shadow_links: links of one band do not tell their direction")

    @property
    def chrominance_bands(self) -> int:
        bands: int = getattr(self.evaluate, "chrominance_bands", 0)  # DirectLinks has no caches' light
        return bands

    def precompute(self, scene: Scene, pieces: Pieces) -> dict[str, Any]:
        return composition_pieces.precompute(self, scene, pieces)

    def shows(self, scene: Scene, prepared: Scene) -> bool:
        """What surfaces emit belongs to the frame."""
        return scene is prepared or scene.surface_hash == prepared.surface_hash

    @property
    def pieces_key(self) -> tuple[Any, ...]:
        return composition_pieces.key_of(self)

    @property
    def precomputed_by(self) -> str:
        """Surfels, tree, caches and links; not what pixels get from the caches."""
        return repr((self.place_surfels, self.cluster_surfels, self.place_caches, self.link, self.links_surfels))

    @property
    def links_surfels(self) -> bool:
        """Whether surfels have caches of their own, for light that comes to them from other surfels: PixelCaches have none there."""
        several = self.bounces != 1 or self.emitters == "links"
        return several and isinstance(self.place_caches, _core.PixelCaches)

    def to_store(self, state: Mapping[str, Any]) -> dict[str, Any]:
        return composition_pieces.to_store(state)

    def from_store(self, stored: dict[str, Any], scene: Scene) -> dict[str, Any]:
        return composition_pieces.from_store(self, stored, scene)

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        scene, seed = view.scene, view.seed
        with profile.stage("gbuffer") as note:
            gbuffer = note(trace_gbuffer(scene, view.camera, view.size, self.shade))
        view = self.with_emission(self.with_bodies(view, profile), profile)
        at_pixels, at_surfels = self.linked(view, gbuffer, profile)
        if self.lit_caches == "read":
            with profile.stage("used_caches"):
                at_pixels = replace(at_pixels, used=used_caches(at_pixels.sites, gbuffer))
        emitted = self.emitted(view, at_pixels, at_surfels, profile)
        maps = self.shadow_maps(view, profile)
        arrived, kept = self.light(view, at_pixels, at_surfels, emitted, maps, profile)
        with profile.stage("evaluate") as note:
            light = note(self.gathered(arrived, at_pixels, gbuffer, view))
        with profile.stage("shadow") as note:
            direct_light = note(self.direct(view, gbuffer, maps))
        with profile.stage("sky") as note:
            environment = note(sky(self.sky, scene, gbuffer, seed))
        with profile.stage("shade"):
            indirect = shade(gbuffer, light.gathered, light.glossy)
            direct = gbuffer.emission + direct_light.radiance + environment.radiance
        if emitted is not None:
            with profile.stage("evaluate_emitters") as note:
                light = note(self.gathered(emitted[0], at_pixels, gbuffer, view))
                direct = direct + shade(gbuffer, light.gathered, light.glossy)
        return direct, indirect, kept

    def with_emission(self, view: View, profile: Profile) -> View:
        """The frame with surfels that emit what its scene's surfaces do."""
        if self.emitters == "rays" or view.scene.still_hash == view.state["emission_of"]:
            return view
        with profile.stage("surfel_pixels") as note:
            return replace(view, state={**view.state, "pixels": note(surfel_pixels(view.state["surfels"], view.scene))})

    def with_bodies(self, view: View, profile: Profile) -> View:
        """The frame with the bodies' voxels, lit where they are; none without `shadow_links`."""
        pyramids: list[_core.Pyramid] = []
        if self.shadow_links is not None:
            with profile.stage("light_bodies") as note:
                pyramids = lit_bodies(self.shadow_links, view, note)
        return replace(view, state={**view.state, "body_pyramids": pyramids})

    def linked(self, view: View, gbuffer: _core.GBuffer, profile: Profile) -> tuple[Caches, Caches]:
        """Caches and their links for pixels and for surfels: the same, built once, or where they stand at pixels anew in every frame."""
        if "sites" in view.state:
            once = Caches(view.state["sites"], view.state["links"])
            return once, once
        with profile.stage("place_caches") as note:
            sites = note(place_caches(self.place_caches, view.scene, gbuffer))
        with profile.stage("link") as note:
            links = link(self.link, sites, view.state["surfels"], view.scene)
            if links is not None:
                note(links)
        own = Caches(sites, links)
        return own, Caches(view.state["surfel_sites"], view.state["surfel_links"]) if self.links_surfels else own

    def emitted(
        self, view: View, at_pixels: Caches, at_surfels: Caches, profile: Profile
    ) -> tuple[CacheLight, CacheLight] | None:
        """What emitters send to the caches of pixels and of surfels; None where rays bring it."""
        if self.emitters == "rays":
            return None
        sent = np.asarray(view.state["pixels"].emission)
        # What bodies reflect is no light of emitters alone: it is added once, to what the lit surfels send.
        to_surfels = self.pass_on(view, sent, at_surfels, 0, profile, reflect=False)
        same = at_surfels.sites is at_pixels.sites
        return to_surfels if same else self.pass_on(view, sent, at_pixels, 0, profile, reflect=False), to_surfels

    def shadow_maps(self, view: View, profile: Profile) -> _core.ShadowMaps | None:
        """Those that pixels and surfels share."""
        if not isinstance(self.shadow, _core.ShadowMap):
            return None
        with profile.stage("shadow_maps") as note:
            return note(shadow_maps(self.shadow, view.scene))

    def direct(self, view: View, gbuffer: _core.GBuffer, maps: _core.ShadowMaps | None) -> _core.DirectLight:
        """What lights send, and by rays emitters."""
        return (shadow if self.emitters == "rays" else lamp_shadow)(self.shadow, view.scene, gbuffer, view.seed, maps=maps)

    def light(
        self,
        view: View,
        at_pixels: Caches,
        at_surfels: Caches,
        emitted: tuple[CacheLight, CacheLight] | None,
        maps: _core.ShadowMaps | None,
        profile: Profile,
    ) -> tuple[CacheLight, CacheLight | None]:
        """What comes of all bounces asked for to the caches of pixels, and to those of surfels for the next frame."""
        with profile.stage("light_surfels") as note:
            lit = self.light_surfels(view, maps, note)
            if emitted is not None:
                lit = lit + self.reflected(view, emitted[1], at_surfels, note)
        last: CacheLight | None = view.history if self.bounces is None else None
        passes = self.bounces if self.bounces is not None else 1 if last is not None else MOST_PASSES
        sent, together = lit, at_surfels is at_pixels
        for bounce in range(passes):
            if last is not None:
                with profile.stage("light_surfels_again") as note:
                    before, sent = sent, lit + self.reflected(view, last, at_surfels, note)
                if self.bounces is None and view.history is None and converged(before, sent):
                    break
            if together or bounce < passes - 1 or self.bounces is None:
                last = self.pass_on(view, sent, at_surfels, bounce, profile)
        if together:
            assert last is not None
            return last, last
        return self.pass_on(view, sent, at_pixels, 0, profile), last

    def pass_on(self, view: View, sent: NDArray[np.float32], to: Caches, bounce: int, profile: Profile, reflect: bool = True) -> CacheLight:
        """From the surfels to caches. reflect: whether what bodies reflect of direct light goes with it."""
        surfels = view.state["surfels"]
        with profile.stage("pull") as note:
            patches = note(pull(surfels, sent, getattr(self.link, "pull", "flux") == "radiosity", self.patch_light != "floats"))
        links = to.links
        if isinstance(links, _core.LinkCandidates):
            with profile.stage("choose_links") as note:
                links = note(_core.choose_links(self.link, links, surfels, patches, to.used))
        if isinstance(self.evaluate, _core.DirectLinks):
            return CacheLight(None, patches, links)
        with profile.stage("light_caches") as note:
            seed = (view.seed + bounce) % 2**32
            caches = note(
                light_caches(self.link, links, to.sites, surfels, patches, view.scene, self.chrominance_bands, seed, used=to.used)
            )  # fmt: skip
        if view.state["body_pyramids"] and links is not None:
            with profile.stage("shadow_links") as note:
                met = (links, patches, to.sites, surfels, view.state["body_pyramids"], view.scene.core)
                note.counts |= _core.shadow_links(self.shadow_links, caches, *met, reflect=reflect).asdict()
        _core.window_caches(caches, getattr(self.evaluate, "window", "none"))
        return CacheLight(caches, patches, links)

    def gathered(self, light: CacheLight, caches: Caches, gbuffer: _core.GBuffer, view: View) -> _core.SurfelLight:
        links = self.link if isinstance(self.link, _core.AllSurfels) else light.links
        surfels = view.state["surfels"]
        return evaluate(self.evaluate, light.caches, caches.sites, gbuffer, view.scene, links, light.patches, surfels, view.seed)

    def light_surfels(self, view: View, maps: _core.ShadowMaps | None, note: Any) -> NDArray[np.float32]:
        """(rows, columns, 3): radiance that surfels reflect of the lights', and by rays of the emitters'."""
        pixels = view.state["pixels"]
        lights = note(self.direct(view, pixels, maps))
        # Neighbours in the list of surfels are none in a picture: nothing may be filtered over them.
        environment = note(sky(self.sky.replace(filter_radius=0), view.scene, pixels, view.seed))
        radiance: NDArray[np.float32] = lights.radiance + environment.radiance
        return radiance

    def reflected(self, view: View, last: CacheLight, at_surfels: Caches, note: Any) -> NDArray[np.float32]:
        """(rows, columns, 3): radiance that surfels reflect of the caches'."""
        pixels = view.state["pixels"]
        return shade(pixels, note(self.gathered(last, at_surfels, pixels, view)).gathered)


def converged(before: NDArray[np.float32], after: NDArray[np.float32]) -> bool:
    """Whether light grew by less than CONVERGED of itself."""
    return float(np.abs(after - before).sum()) <= CONVERGED * float(after.sum())
