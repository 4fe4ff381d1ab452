"""Failures of still pictures: bands, holes, shadows, colours."""

from __future__ import annotations

from typing import Any

from interreflect import scenes
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Failure
from interreflect.stability.measures import leaks, pictures
from interreflect.stability.voxel_failures import ONE_PER_CENT, ZERO

REFERENCE = "path-traced reference of the method's bounces; its own noise is the floor"
VISIBLE = "2 %, about the least contrast that is seen in a smooth shade (Weber)"


def _against_truth(metric: pictures.Metric, **row: Any) -> Failure:
    return Failure(measure=pictures.against_truth(metric), truth=REFERENCE, **row)


def _behind_bars(width: float) -> Scene:
    """From inside the room: white bars lit by it, before the sky."""
    inside = Camera(position=(0.3, 1.5, -1.2), target=(0, 1.2, 1.4), fov_x=62)
    return scenes.grille(width=width).replace(cameras={"inside": inside}, materials={"iron": {"albedo": (0.7,) * 3}})


def _glossy_room(**lobe: Any) -> Scene:
    keys = {"albedo": (0.12,) * 3, "specular": (0.65,) * 3, **lobe}
    return scenes.cornell_box("area").replace(materials={"tall block": keys})


STILL = (
    _against_truth(
        pictures.bands,
        name="banding",
        knob="radius of a ball, and with it of all that is seen",
        unit="extents",
        easy=0.1,
        hard=0.005,
        scene=lambda r: scenes.ball_on_floor(r),
        quantity="root mean square of the error's high frequencies over the mean of indirect light",
        tolerance=0.05,
        reason="by choice 5 %, two to five times the least contrast that is seen, as the truth itself has 1 to 2 % of noise",
        stages=("march", "share", "interpolate", "shade_lights"),
        size=(48, 36),
    ),
    Failure(
        name="self-illumination",
        knob="radius of a ball alone in the sun",
        unit="extents",
        easy=0.3,
        hard=0.005,
        scene=lambda r: scenes.lone_ball(r),
        measure=leaks.self_illumination,
        quantity="indirect over direct light",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("march", "voxelize", "shade_lights"),
    ),
    _against_truth(
        pictures.holes,
        name="pixels without light",
        knob="width of the bars of a grille",
        unit="m",
        easy=0.05,
        hard=0.004,
        scene=_behind_bars,
        quantity="share of pixels that get less than a tenth of the indirect light due to them",
        tolerance=0.01,
        reason="by choice one pixel in a hundred",
        stages=("interpolate", "share", "march"),
        size=(96, 72),
    ),
    _against_truth(
        pictures.peak,
        name="singularity in a corner",
        knob="height of a spot above the corner",
        unit="wall heights",
        easy=0.45,
        hard=0.02,
        scene=lambda a: scenes.corner("spot", aim=a, cap=4.0),
        quantity="largest indirect radiance over the truth's, less 1",
        tolerance=0.25,
        reason="by choice a quarter: a bright dot that stands out",
        stages=("shade_lights", "sample_lights"),
        camera="view",
    ),
    _against_truth(
        pictures.energy,
        name="energy lost in a corner",
        knob="height of a spot above the corner",
        unit="wall heights",
        easy=0.45,
        hard=0.02,
        scene=lambda a: scenes.corner("spot", aim=a, cap=4.0),
        quantity="energy ratio of indirect light, less 1",
        tolerance=0.1,
        reason="by choice a tenth of the light, as clamping takes it",
        stages=("shade_lights", "sample_lights"),
        camera="view",
    ),
    Failure(
        name="holes and leaks of shadows",
        knob="height of a blade, length of its shadow",
        unit="extents",
        easy=0.2,
        hard=0.002,
        scene=lambda h: scenes.blade(h),
        measure=leaks.false_shadow,
        quantity="share of light that is wrong in the umbra and beside it",
        truth="closed form: 0 in the umbra, albedo times irradiance over pi beside it",
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("shadow", "shadow_lights"),
        camera="edge",
        size=(48, 48),
    ),
    Failure(
        name="penumbra",
        knob="height of the blocker's edge",
        unit="extents",
        easy=0.02,
        hard=0.4,
        scene=lambda h: scenes.penumbra(h),
        measure=leaks.penumbra_error,
        quantity="mean error of the shadow's profile over the lit radiance",
        truth="closed form: form factor to the visible part of the light (Howell B-4)",
        tolerance=0.02,
        reason=VISIBLE,
        stages=("shadow", "filter_shadows"),
        camera="edge",
        size=(48, 48),
    ),
    _against_truth(
        pictures.ringing,
        name="ringing of spherical harmonics",
        knob="half angle of a spot that a glossy floor mirrors",
        unit="degrees",
        easy=30.0,
        hard=2.0,
        scene=lambda a: scenes.glossy_receiver(spot=a),
        quantity="depth of negative light over the peak, or share of negative pixels",
        tolerance=0.01,
        reason="light is never negative; 1 % of the peak by choice",
        stages=("evaluate", "preconvolve"),
    ),
    Failure(
        name="bleeding through a grid of probes",
        knob="thickness of the wall beside a ball",
        unit="extents",
        easy=8 / 64,
        hard=1 / 8 / 64,
        scene=lambda t: scenes.thin_wall(thickness=t, ball=0.04),
        measure=lambda trial: leaks.leak_on_body(trial, "ball"),
        quantity="mean radiance of a ball in the dark room over that of the lit room",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("place_caches",),
    ),
    Failure(
        name="leak between corridors",
        knob="thickness of the slab between two corridors",
        unit="m",
        easy=2.0,
        hard=0.02,
        scene=lambda t: scenes.corridors(thickness=t),
        measure=leaks.leak,
        quantity="mean radiance of the dark corridor over that of the lit one",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("cluster_surfels", "link", "march"),
    ),
    _against_truth(
        pictures.jump,
        name="discontinuity between links",
        knob="half angle of a spot on a wall",
        unit="degrees",
        easy=30.0,
        hard=10.0,  # below, the truth is too noisy to tell
        scene=lambda a: scenes.corner("spot", aim=0.3, cap=a),
        quantity="largest jump between neighbouring pixels beyond the truth's, over the mean of indirect light",
        tolerance=0.25,
        reason="by choice a quarter of the mean: an edge where there is none",
        stages=("link",),
        camera="receiver",
        size=(48, 48),
    ),
    _against_truth(
        pictures.seam,
        name="misplaced texels",
        knob="how deep a box is sunk into the floor",
        unit="extents",
        easy=0.002,
        hard=0.15,
        scene=lambda d: scenes.sunk_box(depth=d),
        quantity="mean error of indirect light beside edges, over its mean there",
        tolerance=0.25,
        reason="by choice a quarter: a seam that stands out",
        stages=("place_caches",),
    ),
    _against_truth(
        pictures.hue,
        name="shift of chrominance",
        knob="saturation of two opposed lights",
        unit="",
        easy=0.05,
        hard=1.0,
        logarithmic=False,
        scene=lambda s: scenes.opposed_lights(s),
        quantity="mean hue difference, degrees (or 180 times the share of negative light)",
        tolerance=5.0,
        reason="by choice 5 degrees of hue",
        stages=("evaluate",),
    ),
    _against_truth(
        pictures.energy,
        name="roughness towards 0",
        knob="roughness of a glossy block",
        unit="",
        easy=1.0,
        hard=0.0,
        logarithmic=False,
        scene=lambda r: _glossy_room(roughness=r),
        quantity="energy ratio of indirect light, less 1",
        tolerance=0.1,
        reason="by choice a tenth of indirect light, most of which is diffuse",
        stages=(),
    ),
    _against_truth(
        pictures.energy,
        name="sharp Phong lobe",
        knob="exponent of a glossy floor",
        unit="",
        easy=5.0,
        hard=1000.0,
        scene=lambda n: scenes.glossy_receiver(exponent=n),
        quantity="energy ratio of indirect light, less 1",
        tolerance=0.1,
        reason="by choice a tenth of indirect light, most of which is the lobe's",
        stages=(),
    ),
    _against_truth(
        pictures.energy,
        name="black surfaces",
        knob="albedo of a whole room",
        unit="",
        easy=0.7,
        hard=1e-3,
        scene=lambda a: scenes.cornell_box("point").replace(materials={"*": {"albedo": (a,) * 3}}),
        quantity="energy ratio of indirect light, less 1",
        tolerance=0.1,
        reason="by choice a tenth of indirect light",
        stages=(),
    ),
)
