"""Illuminance composition as the papers' tables look at it: what was precomputed is counted, frames follow frames, and surfels, caches
and links are drawn."""

from __future__ import annotations

import dataclasses
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from interreflect import _core
from interreflect.clusters import number_colours
from interreflect.frame import Image
from interreflect.images import tone_map
from interreflect.methods.composition_presets import PRESETS
from interreflect.methods.illuminance_composition import IlluminanceComposition
from interreflect.methods.knobs import knob
from interreflect.methods.method import method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.spacing import HEXAGONAL, surfel_spacing
from interreflect.stages import trace_gbuffer

MILLIONTHS = 1e6
EDGE = 0.85  # of a disk's radius: what lies beyond is drawn dark


@method
class MeasuredComposition(IlluminanceComposition):
    """The method with a stage `precomputed` that does nothing; its counts: `surfels`, `caches`, `links` of each cache, and bytes of the
    surfels and their tree, `surfel_bytes`, of where caches stand, `site_bytes`, and of the links, `link_bytes`."""

    preset_values: ClassVar[Any] = PRESETS

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        with profile.stage("precomputed") as note:
            note.counts.update(precomputed_counts(view.state))
        return super().compose(view, profile)


def precomputed_counts(state: dict[str, Any]) -> dict[str, int]:
    surfels = state["surfels"]
    counts = {"surfels": len(surfels), "surfel_bytes": surfels.bytes}
    if "sites" in state:
        counts |= {"caches": len(state["sites"]), "site_bytes": state["sites"].bytes}
    if state.get("links") is not None:
        counts |= {"links": state["links"].per_cache, "link_bytes": state["links"].bytes}
    return counts


@method
class ProgressiveComposition(MeasuredComposition):
    """The last of some frames of a still scene, the first of them with one bounce, each further one with one bounce more [5.1].

    The stages' times and counts are those of the last frame.
    """

    frames: int = knob(default=1, doc="of which the last is shown", minimum=1, maximum=256)

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        history = None
        for k in range(self.frames - 1):
            way = self.replace(bounces=1 if k == 0 else None, frames=1)
            *_, history = IlluminanceComposition.compose(way, dataclasses.replace(view, history=history), Profile())
        last = self.replace(bounces=1 if history is None else None, frames=1)
        return MeasuredComposition.compose(last, dataclasses.replace(view, history=history), profile)


@method
class CompositionPicture(MeasuredComposition):
    """What a camera sees of the precomputation. `surfels`: disks of their areas, each in its colour, black where none reaches;
    `caches`: the surface by its nearest cache's colour; `links`: of the cache nearest to the middle of the picture, each linked patch in
    its colour, grey what belongs to none, and a green dot where the cache stands.

    Counts of the stage `picture`: of `surfels`, `spacing_mean` and `spacing_deviation` of the distance to the nearest neighbour, in
    millionths of the spacing sqrt(2 area / sqrt 3) of a hexagonal grid; `gaps`, `pixels`: pixels of no surfel, and of any surface.
    """

    show: str = knob(default="surfels", doc="what is drawn", choices=("surfels", "caches", "links"))

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image, Any]:
        with profile.stage("precomputed") as note:
            note.counts.update(precomputed_counts(view.state))
        gbuffer = trace_gbuffer(view.scene, view.camera, view.size)
        seen = np.isfinite(gbuffer.depth)
        with profile.stage("picture") as note:
            draw = {"surfels": _surfels, "caches": _caches, "links": _links}[self.show]
            picture = np.zeros((*seen.shape, 3), np.float32)
            picture[seen] = draw(view.state, gbuffer, seen, note.counts)
        return picture, np.zeros_like(picture), None


def _surfels(state: dict[str, Any], gbuffer: _core.GBuffer, seen: NDArray[np.bool_], counts: Any) -> NDArray[np.float32]:
    surfels = state["surfels"].surfels
    tree = cKDTree(surfels.position)
    spacing = surfel_spacing(surfels).distance / HEXAGONAL
    distance, nearest = tree.query(gbuffer.position[seen])
    radius = np.sqrt(surfels.area[nearest] / np.pi)
    gaps = distance > radius
    counts.update(
        spacing_mean=round(MILLIONTHS * float(spacing.mean())), spacing_deviation=round(MILLIONTHS * float(spacing.std())),
        gaps=int(gaps.sum()), pixels=int(seen.sum()),
    )  # fmt: skip
    colours = number_colours(len(surfels))[nearest]
    colours[distance > EDGE * radius] *= np.float32(0.4)
    colours[gaps] = 0
    return colours


def _caches(state: dict[str, Any], gbuffer: _core.GBuffer, seen: NDArray[np.bool_], _counts: Any) -> NDArray[np.float32]:
    """Over the albedo: a cache of a map is looked for among those that face the way the surface does."""
    position, normal, albedo = gbuffer.position[seen], gbuffer.normal[seen], tone_map(gbuffer.albedo[seen]) / np.float32(255)
    sites = state["sites"]
    nearest = cKDTree(_placed(sites.position, sites.normal)).query(_placed(position, normal))[1]
    colours = number_colours(len(sites))[nearest]
    return np.asarray(0.75 * colours + 0.25 * albedo, np.float32)


def _placed(position: NDArray[np.floating], normal: NDArray[np.floating]) -> NDArray[np.float64]:
    """Positions with normals as lengths of a hundredth of the extent of what is seen."""
    reach = 0.01 * float(np.linalg.norm(np.ptp(position, axis=0)))
    return np.concatenate((np.asarray(position, np.float64), reach * np.asarray(normal, np.float64)), axis=1)


def _links(state: dict[str, Any], gbuffer: _core.GBuffer, seen: NDArray[np.bool_], counts: Any) -> NDArray[np.float32]:
    tree, sites, links = state["surfels"], state["sites"], state["links"]
    height, width = seen.shape
    if not seen[height // 2, width // 2]:
        raise ValueError("the middle of the picture shows no surface that a cache could stand on")
    cache = int(cKDTree(sites.position).query(gbuffer.position[height // 2, width // 2])[1])
    owner = np.full(len(tree), -1)
    nodes = links.node[cache]
    for number, node in enumerate(nodes):
        end = int(tree.leaf_end[node])
        owner[end - int(tree.leaves[node]) : end] = number
    counts.update(linked_surfels=int((owner >= 0).sum()), patches=len(np.unique(nodes)))
    belongs = owner[cKDTree(tree.surfels.position).query(gbuffer.position[seen])[1]]
    colours = np.concatenate((number_colours(len(nodes)), np.full((1, 3), 0.15, np.float32)))[belongs]
    reach = 0.004 * float(np.linalg.norm(np.ptp(gbuffer.position[seen], axis=0)))
    colours[np.linalg.norm(gbuffer.position[seen] - sites.position[cache], axis=1) < reach] = (0.05, 1.0, 0.1)
    return colours
