"""Failures of illuminance composition against its own knobs: links, bands, texels, cells, surfels [Jendersie et al. 2016, 5.2, 5.3.2]."""

from __future__ import annotations

from typing import Any

from interreflect import scenes
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Failure
from interreflect.stability.measures import composition, leaks, pictures
from interreflect.stability.measures.virtual_lights import with_knob
from interreflect.stability.still_failures import REFERENCE
from interreflect.stability.voxel_failures import ZERO


def _far_lamp(_: float) -> Scene:
    """The lower corridor, lit from its far end alone."""
    hall = scenes.corridors(length=16.0)
    return hall.replace(lights=[hall.lights[-1]])


def _swept(name: str, path: str, metric: pictures.Metric, **row: Any) -> Failure:
    """A picture against the truth, with the method's knob `path` at the swept value."""
    whole = path != "place_caches.most_backs"
    return Failure(name=name, measure=with_knob(path, pictures.against_truth(metric), whole), truth=REFERENCE, **row)


COMPOSITION = (
    Failure(
        name="leak between corridors by links",
        knob="links of a cache",
        unit="links",
        easy=1024.0,
        hard=4.0,
        scene=lambda _: scenes.corridors(),
        measure=with_knob("link.links", leaks.leak, whole=True),
        quantity="mean radiance of the dark corridor over that of the lit one",
        truth=ZERO,
        tolerance=1e-3,
        reason="by choice a thousandth: what the paper has to amplify 4096 times stays below",
        stages=("link",),
    ),
    _swept(
        "discontinuity between few links",
        "link.links",
        pictures.jump,
        knob="links of a cache",
        unit="links",
        easy=1024.0,
        hard=8.0,
        scene=lambda _: scenes.corner("spot", aim=0.3, cap=16.0),
        quantity="largest jump between neighbouring pixels beyond the truth's, over the mean of indirect light",
        tolerance=0.25,
        reason="by choice a quarter of the mean: an edge where there is none",
        stages=("link",),
        camera="receiver",
        size=(48, 48),
    ),
    _swept(
        "texels behind other geometry",
        "place_caches.most_backs",
        pictures.seam,
        knob="share of backs that a texel may see",
        unit="",
        easy=0.05,
        hard=1.0,
        logarithmic=False,
        scene=lambda _: scenes.sunk_box(depth=0.1),
        quantity="mean error of indirect light beside edges, over its mean there",
        tolerance=0.1,
        reason="by choice a tenth: a seam that is seen",
        stages=("place_caches",),
    ),
    Failure(
        name="negative radiance about a patch",
        knob="half angle of a spot on the wall before the caches",
        unit="degrees",
        easy=40.0,
        hard=2.0,
        scene=lambda a: scenes.glossy_receiver(spot=a, exponent=30.0),
        measure=composition.negative_radiance,
        quantity="negative radiance over positive, over all caches and directions",
        truth=ZERO,
        tolerance=0.2,
        reason="light is never negative; by choice a fifth of it",
        stages=("link", "evaluate"),
    ),
    _swept(
        "chrominance of few bands",
        "evaluate.chrominance_bands",
        pictures.hue,
        knob="bands of chrominance",
        unit="bands",
        easy=4.0,
        hard=1.0,
        logarithmic=False,
        scene=lambda _: scenes.opposed_lights(1.0),
        quantity="mean hue difference, degrees (or 180 times the share of negative light)",
        tolerance=5.0,
        reason="by choice 5 degrees of hue",
        stages=("evaluate",),
    ),
    Failure(
        name="bleeding through a cell",
        knob="cells of a grid of caches along the scene, beside a wall of a fiftieth of it",
        unit="cells",
        easy=24.0,
        hard=4.0,
        scene=lambda _: scenes.thin_wall(thickness=0.02, ball=0.04),
        measure=lambda trial: composition.leak_by_cells(trial, "ball"),
        quantity="mean radiance of a ball in the dark room over that of the lit room",
        truth=ZERO,
        tolerance=1e-3,
        reason="by choice a thousandth, as between corridors",
        stages=("place_caches",),
    ),
    Failure(
        name="far light by surfels",
        knob="surfels of a corridor that is lit from its other end",
        unit="surfels",
        easy=4096.0,
        hard=262144.0,
        scene=_far_lamp,
        measure=with_knob("place_surfels.surfels", composition.far_light, whole=True),
        quantity="mean indirect light at the camera's end over the truth's, less 1",
        truth=REFERENCE,
        tolerance=0.1,
        reason="by choice a tenth of the light",
        stages=("place_surfels", "link"),
        camera="lit",
    ),
    Failure(
        name="far light by links",
        knob="links of a cache in a corridor that is lit from its other end",
        unit="links",
        easy=1024.0,
        hard=8.0,
        scene=_far_lamp,
        measure=with_knob("link.links", composition.far_light, whole=True),
        quantity="mean indirect light at the camera's end over the truth's, less 1",
        truth=REFERENCE,
        tolerance=0.1,
        reason="by choice a tenth of the light",
        stages=("link",),
        camera="lit",
    ),
)
