"""Failures of virtual lights: singular points and what clamping them loses, maps with holes, penumbras, clusters that jump."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from interreflect import scenes
from interreflect.frame import Image
from interreflect.motion import Motion
from interreflect.scenes.scene import Scene
from interreflect.stability import moving_failures as motions
from interreflect.stability.failure import Failure, Trial
from interreflect.stability.measures import pictures, virtual_lights
from interreflect.stability.measures.virtual_lights import with_knob
from interreflect.stability.still_failures import REFERENCE, VISIBLE
from interreflect.stability.temporal import POP
from interreflect.stability.voxel_failures import ONE_PER_CENT, ZERO

TEXEL = 4 / 128 * 0.3  # extents: of the middle of a map of 128, at the blockers' distance from the patch
TURNS = 8  # places of a spot over which an error of flux is averaged


def _corner(_: float) -> Scene:
    """The corner of closed form 6, its wall lit evenly."""
    return scenes.corner("sun")


def _chequered(_: float) -> Scene:
    return scenes.corner("spot", fields=8)


def _turning(step: float) -> Motion:
    return Motion.turning_light(by=step, frames=motions.FRAMES)


def _by_reference(name: str, measure: virtual_lights.Measure, **row: Any) -> Failure:
    return Failure(name=name, measure=measure, truth=REFERENCE, **row)


def _in_corner(name: str, measure: virtual_lights.Measure, **row: Any) -> Failure:
    return _by_reference(name, measure, scene=_corner, camera="receiver", size=(48, 48), **row)


def _dots(image: Image, truth: Image, trial: Trial) -> float:
    """Largest of the picture over the truth's largest, less 1; 0 where it is darker."""
    return max(0.0, pictures.peak(image, truth, trial))


def _peak(name: str, path: str, **row: Any) -> Failure:
    return _in_corner(
        name,
        with_knob(path, pictures.against_truth(_dots), whole=path.endswith("lights")),
        quantity="largest indirect radiance of the floor over the truth's, less 1",
        tolerance=0.25,
        reason="by choice a quarter: a bright dot that stands out",
        stages=("shade_lights", "sample_lights"),
        **row,
    )


def _in_umbra(name: str, path: str, **row: Any) -> Failure:
    return Failure(
        name=name,
        scene=lambda _: scenes.lit_patch("plate"),
        measure=with_knob(path, virtual_lights.light_in_umbra, whole=path != "shadow_lights.point_size"),
        quantity="light in the umbra of a plate over that without the plate",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("shadow_lights",),
        size=(48, 48),
        **row,
    )


def _turned(name: str, measure: Callable[[Callable[[float], Motion]], virtual_lights.Measure], **row: Any) -> Failure:
    return Failure(
        name=name,
        knob="turn of a spot on a chequered wall",
        unit="degrees a frame",
        easy=0.1,
        hard=4.0,
        scene=_chequered,
        measure=measure(_turning),
        stages=("cluster_lights",),
        camera="view",
        size=motions.SIZE,
        **row,
    )


CHURN: dict[str, Any] = {
    "quantity": "share of lit surface that belonged to another light a frame before",
    "truth": "closed form: 0 where clusters stay on the surface",
    "tolerance": 0.1,
    "reason": "by choice a tenth of the surface",
}

VIRTUAL_LIGHTS = (
    _peak("singularity of few lights", "sample_lights.lights", knob="lights on a wall", unit="lights", easy=1024.0, hard=4.0),
    _peak(
        "singularity by bound",
        "shade_lights.bound",
        knob="bound of the geometry term",
        unit="1 / extent^2",
        easy=1.0,
        hard=1e5,
    ),
    _in_corner(
        "energy lost to a bound",
        with_knob("shade_lights.bound", pictures.against_truth(pictures.energy)),
        knob="bound of the geometry term",
        unit="1 / extent^2",
        easy=1e5,
        hard=1.0,
        quantity="energy ratio of the floor's indirect light, less 1",
        tolerance=0.1,
        reason="by choice a tenth of the light",
        stages=("shade_lights",),
    ),
    _in_umbra("light in an umbra by points", "shadow_lights.points", knob="points on the scene", unit="points", easy=1e7, hard=1e3),
    _in_umbra(
        "light in an umbra by pull and push",
        "shadow_lights.iterations",
        knob="levels of pull and push",
        unit="levels",
        easy=8.0,
        hard=0.0,
        logarithmic=False,
    ),
    _in_umbra(
        "light in an umbra by size of points",
        "shadow_lights.point_size",
        knob="size of a point's disk",
        unit="diameters",
        easy=4.0,
        hard=0.25,
    ),
    _by_reference(
        "false shadow in a gap",
        virtual_lights.missing_light,
        knob="width of a gap between plates",
        unit="texels of a map of 128",
        easy=32.0,
        hard=0.5,
        scene=lambda texels: scenes.lit_patch("slit", gap=texels * TEXEL),
        quantity="share of the light that is missing where it comes through",
        tolerance=0.25,
        reason="by choice a quarter of the light",
        stages=("shadow_lights",),
        size=(48, 48),
    ),
    _by_reference(
        "width of a penumbra",
        virtual_lights.penumbra_width,
        knob="height of the blocker's edge",
        unit="extents",
        easy=0.4,
        hard=0.02,
        scene=lambda h: scenes.lit_patch("edge", height=h),
        quantity="width of the penumbra over the truth's, which is that of similar triangles, less 1",
        tolerance=0.25,
        reason="by choice a quarter of its width",
        stages=("filter_shadows",),
        size=(64, 48),
    ),
    _by_reference(
        "penumbra of two layers",
        virtual_lights.profile_error,
        knob="height of the upper of two edges, the lower at .05",
        unit="extents",
        easy=0.06,
        hard=0.4,
        scene=lambda h: scenes.lit_patch("edges", height=h),
        quantity="mean error of the shadow's profile over the lit radiance",
        tolerance=0.02,
        reason=VISIBLE,
        stages=("filter_shadows",),
        size=(64, 48),
    ),
    Failure(
        name="flux of clusters on chequers",
        knob="chequers along a side of a wall",
        unit="chequers",
        easy=1.0,
        hard=64.0,
        scene=lambda fields: scenes.corner("spot", fields=round(fields)),
        measure=virtual_lights.flux_error(Motion.turning_light(by=1.0, frames=TURNS)),
        quantity="root mean square of the lights' flux over their texels', less 1",
        truth="closed form: what a light map sends on",
        tolerance=0.05,
        reason="by choice a twentieth of the light",
        stages=("cluster_lights",),
        camera="view",
        size=motions.SIZE,
    ),
    _turned("churn of clusters", lambda step: virtual_lights.churn(step, history=True), **CHURN),
    _turned("churn of clusters made anew", lambda step: virtual_lights.churn(step, history=False), **CHURN),
    _turned(
        "jumps of clusters made anew",
        lambda step: virtual_lights.jumps_without_history(step, "p99"),
        quantity="99th percentile of the temporal error, share of mean radiance",
        truth=motions.REFERENCE,
        tolerance=POP,
        reason=motions.POPS,
    ),
)
