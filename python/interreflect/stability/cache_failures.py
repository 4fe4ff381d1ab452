"""Failures of caches that pixels share: pixels without one, jumps in motion, lobes sharper than a cache, tiles without a surface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from interreflect import scenes
from interreflect.motion import Motion
from interreflect.scenes.scene import Scene
from interreflect.stability import moving_failures as motions
from interreflect.stability.failure import Failure
from interreflect.stability.measures import caches, moving, pictures
from interreflect.stability.still_failures import REFERENCE
from interreflect.stability.temporal import POP
from interreflect.stability.voxel_failures import ZERO


def _uncovered(where: str, knob: str, easy: float, hard: float, scene: Callable[[float], Scene], **row: Any) -> Failure:
    return Failure(
        name=f"pixels without a cache {where}",
        knob=knob,
        unit="m",
        easy=easy,
        hard=hard,
        scene=scene,
        measure=caches.uncovered,
        quantity="share of pixels with a surface whose caches' weights sum up to 0",
        truth=ZERO,
        tolerance=0.01,
        reason="by choice one pixel in a hundred",
        stages=("interpolate",),
        size=(160, 120),
        **row,
    )


CACHES = (
    # A pixel of these pictures is about .015 m wide at the bars and the leaves, .008 to .026 at the wires.
    _uncovered("behind a grille", "width of the bars", 0.1, 0.006, lambda w: scenes.grille(width=w)),
    _uncovered("in foliage", "length of a leaf", 0.4, 0.01, lambda length: scenes.foliage(length)),
    _uncovered("on wires", "width of a wire", 0.2, 0.004, lambda w: scenes.wires(w)),
    Failure(
        name="popping at a depth edge",
        knob="pan of the camera",
        unit="degrees a frame",
        easy=0.05,
        hard=2.0,
        scene=lambda _: scenes.depth_edge(),
        measure=moving.temporal(lambda step: Motion.rotation(by=step, frames=motions.FRAMES), "p99"),
        quantity="99th percentile of the temporal error, share of mean radiance",
        truth=motions.REFERENCE,
        tolerance=POP,
        reason=motions.POPS,
        size=motions.SIZE,
        stages=("share", "distribute", "interpolate"),
    ),
    Failure(
        name="reflection in a sharp lobe",
        knob="exponent of a glossy floor",
        unit="",
        easy=5.0,
        hard=1000.0,
        scene=lambda n: scenes.glossy_receiver(exponent=n),
        measure=caches.blurred,
        quantity="mean change of indirect light over its mean",
        truth="the picture in which every pixel has a fine cache of its own, filled from the same voxels",
        tolerance=0.2,
        reason="by choice a fifth of the light is elsewhere",
        stages=("interpolate", "preconvolve"),
        size=(48, 36),
    ),
    Failure(
        name="tiles that see the sky alone",
        knob="radius of a ball in the sky",
        unit="extents",
        easy=0.15,
        hard=0.02,
        scene=lambda r: scenes.ball_in_sky(r),
        measure=pictures.against_truth(pictures.holes),
        quantity="share of pixels that get less than a tenth of the indirect light due to them",
        truth=REFERENCE,
        tolerance=0.01,
        reason="by choice one pixel in a hundred",
        stages=("distribute", "interpolate"),
        size=(96, 72),
    ),
)
