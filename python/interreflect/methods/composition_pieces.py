"""Illuminance composition's precomputation: surfels, tree, sites of caches and links, shared between methods and stored in files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from interreflect import _core
from interreflect.methods.pieces import Pieces
from interreflect.scenes.scene import WORLD, Scene
from interreflect.stages import cluster_surfels, link, place_caches, place_surfels, surfel_pixels

if TYPE_CHECKING:
    from interreflect.methods.illuminance_composition import IlluminanceComposition

MOST_CUT_BYTES = 4 * 2**30  # what a shared cut may hold
BYTES_OF_A_LINK = 4 + 2 * 8**2 + 12  # in a shared cut: node, coefficients of 8 bands, cone


def key_of(method: IlluminanceComposition) -> tuple[Any, ...]:
    """What the pieces depend on, the one that most build on first."""
    sites = () if isinstance(method.place_caches, _core.PixelCaches) else (method.place_caches, cut_of(method.link))
    return (method.place_surfels, method.cluster_surfels, *sites)


def cut_of(technique: Any) -> Any:
    """The knobs that choose a cut of the tree; None where there is none."""
    if isinstance(technique, _core.AllSurfels):
        return None
    # How many of its candidates become links, FluxLinks chooses in every frame.
    width = "candidates" if isinstance(technique, _core.FluxLinks) else "links"
    return tuple((name, getattr(technique, name)) for name in (width, "rays", "near_rays", "pull"))


def without_bodies(scene: Scene) -> Scene:
    """What stands still: what is precomputed must not depend on where bodies happen to be."""
    if all(mesh.body == WORLD for mesh in scene.meshes):
        return scene
    meshes = [mesh for mesh in scene.meshes if mesh.body == WORLD]
    return Scene(meshes=meshes, lights=scene.lights, name=scene.name, up=scene.up, unit=scene.unit)


def precompute(method: IlluminanceComposition, scene: Scene, pieces: Pieces) -> dict[str, Any]:
    still = without_bodies(scene)
    placed_by, clustered_by = (method.place_surfels,), (method.place_surfels, method.cluster_surfels)
    placed = pieces.take("surfels", placed_by, lambda: place_surfels(method.place_surfels, still))
    surfels = pieces.take("tree", clustered_by, lambda: cluster_surfels(method.cluster_surfels, placed))
    pixels = pieces.take("pixels", clustered_by, lambda: surfel_pixels(surfels, scene))
    state = {"surfels": surfels, "pixels": pixels, "emission_of": scene.still_hash}
    if method.links_surfels:
        by = (*clustered_by, method.link)
        state |= pieces.take("surfel_links", by, lambda: surfel_links(method.link, surfels, pixels, still))
    if not isinstance(method.place_caches, _core.PixelCaches):
        sites = pieces.take("sites", (method.place_caches,), lambda: place_caches(method.place_caches, still, None, scene))
        if len(surfels) > 0 and len(sites) == 0:
            raise ValueError(f"place_caches: every cache of {method.place_caches!r} lies in a solid or behind a wall")
        state |= {"sites": sites, "links": _links(method, sites, surfels, still, pieces)}
    return state


def _links(method: IlluminanceComposition, sites: _core.CacheSites, surfels: _core.ClusteredSurfels, still: Scene, pieces: Pieces) -> Any:
    """Where pieces are kept, out of one cut for links of any kind and bands: the same bits as without."""
    technique = method.link
    if isinstance(technique, _core.FluxLinks):
        return pieces.take("candidates", key_of(method), lambda: link(technique, sites, surfels, still))
    cut = cut_of(technique)
    if cut is None or not pieces.keeps or len(sites) * technique.links * BYTES_OF_A_LINK > MOST_CUT_BYTES:
        return link(technique, sites, surfels, still)
    shared = pieces.take("cut", key_of(method), lambda: _core.shared_cut(technique, sites, surfels, still.core))
    return _core.take_links(technique, shared)


def surfel_links(technique: Any, surfels: _core.ClusteredSurfels, pixels: _core.GBuffer, still: Scene) -> dict[str, Any]:
    """A cache at every surfel, for the light that comes to it."""
    sites = place_caches(_core.PixelCaches(), still, pixels)
    return {"surfel_sites": sites, "surfel_links": link(technique, sites, surfels, still)}


PARTS = ("surfels", "sites", "links")


def to_store(state: Mapping[str, Any]) -> dict[str, Any]:
    parts = {part: _core.to_store(state[part]) for part in PARTS if state.get(part) is not None}
    return {f"{part}.{name}": value for part, values in parts.items() for name, value in values.items()}


def from_store(method: IlluminanceComposition, stored: Mapping[str, Any], scene: Scene) -> dict[str, Any]:
    parts: dict[str, dict[str, Any]] = {part: {} for part in PARTS}
    for name, value in stored.items():
        part, _, field = name.partition(".")
        parts[part][field] = value
    surfels = _core.surfels_from_store(parts["surfels"], scene.core)
    pixels = surfel_pixels(surfels, scene)
    state: dict[str, Any] = {"surfels": surfels, "pixels": pixels, "emission_of": scene.still_hash}
    if method.links_surfels:
        state |= surfel_links(method.link, surfels, pixels, without_bodies(scene))
    if parts["sites"]:
        state["sites"] = _core.sites_from_store(parts["sites"], scene.core)
        restore = _core.candidates_from_store if isinstance(method.link, _core.FluxLinks) else _core.links_from_store
        state["links"] = restore(parts["links"], state["sites"], surfels) if parts["links"] else None
    return state
