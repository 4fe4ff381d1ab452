"""Failures that show in motion, or when the whole scene is moved or scaled; and the furnace that shows lost energy."""

from __future__ import annotations

from interreflect import scenes
from interreflect.motion import Motion
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Failure
from interreflect.stability.measures import moving, transformed
from interreflect.stability.similar import similar
from interreflect.stability.temporal import POP

FRAMES = 4
SIZE = (48, 36)
REFERENCE = "path-traced reference of every frame, read at the same surface points; its own noise is the floor"
FLICKERS = (
    "by choice at most one surface point in twenty changes by more than 5 % of the mean radiance; means hide a grid that is not snapped"
)
DRIFTS = "2 %, about the least contrast that is seen"
POPS = "by choice at most one surface point in a hundred jumps by more than a tenth of the mean radiance"
ROUNDS = "rounding puts surfaces on the border of two voxels into either, and lets rays past edges on either side: a pixel in a hundred"


def _room(_: float) -> Scene:
    return scenes.cornell_box("point")


def _room_from_inside(_: float) -> Scene:
    """Seen from within, where grids about the camera have voxels."""
    inside = Camera(position=(-0.2, 1.1, 0.85), target=(0.1, 0.8, -1.0), fov_x=80)
    return _room(0).replace(cameras={"inside": inside})


def _corner(_: float) -> Scene:
    return scenes.corner("spot", fields=8)


def _scaled(name: str, hard: float) -> Failure:
    return Failure(
        name=name,
        knob="factor on all lengths",
        unit="",
        easy=1.0,
        hard=hard,
        scene=lambda factor: similar(_room(0), scale=factor),
        measure=transformed.change(_room(0)),
        quantity="mean change of the picture over its mean, same seed",
        truth="the picture at scale 1",
        tolerance=0.01,
        reason=ROUNDS,
        stages=(),
    )


MOVING = (
    Failure(
        name="flicker under a dolly",
        knob="step of the camera",
        unit="voxels of a grid of 64 a frame",
        easy=1 / 16,
        hard=4.0,
        scene=_room_from_inside,
        measure=moving.temporal(lambda step: Motion.dolly(by=(step, 0.3 * step, 0), voxels=64, frames=FRAMES), "p95"),
        quantity="95th percentile of the temporal error at surface points, share of mean radiance",
        truth=REFERENCE,
        tolerance=0.05,
        reason=FLICKERS,
        size=SIZE,
        stages=("voxelize", "march", "share"),
    ),
    Failure(
        name="flicker under rotation",
        knob="turn of the camera",
        unit="degrees a frame",
        easy=0.05,
        hard=4.0,
        scene=_room_from_inside,
        measure=moving.temporal(lambda step: Motion.rotation(by=step, frames=FRAMES), "p95"),
        quantity="95th percentile of the temporal error at surface points, share of mean radiance",
        truth=REFERENCE,
        tolerance=0.05,
        reason=FLICKERS,
        size=SIZE,
        stages=("voxelize", "march", "share"),
    ),
    Failure(
        name="popping behind a grille",
        knob="pan of the camera",
        unit="degrees a frame",
        easy=0.05,
        hard=2.0,
        scene=lambda _: scenes.grille(),
        measure=moving.temporal(lambda step: Motion.rotation(by=step, frames=FRAMES), "p99"),
        quantity="99th percentile of the temporal error, share of mean radiance",
        truth=REFERENCE,
        tolerance=POP,
        reason=POPS,
        size=SIZE,
        stages=("share", "distribute", "interpolate"),
    ),
    Failure(
        name="jumps of clusters",
        knob="turn of a spot on a chequered wall",
        unit="degrees a frame",
        easy=0.1,
        hard=4.0,
        scene=_corner,
        measure=moving.temporal(lambda step: Motion.turning_light(by=step, frames=FRAMES), "p99"),
        quantity="99th percentile of the temporal error, share of mean radiance",
        truth=REFERENCE,
        tolerance=POP,
        reason=POPS,
        size=SIZE,
        stages=("cluster_lights",),
        camera="view",
    ),
    Failure(
        name="drift of flux between clusters",
        knob="turn of a spot on a chequered wall",
        unit="degrees a frame",
        easy=0.1,
        hard=4.0,
        scene=_corner,
        measure=moving.flux_drift(lambda step: Motion.turning_light(by=step, frames=FRAMES)),
        quantity="largest change of the energy ratio from frame to frame",
        truth=REFERENCE,
        tolerance=0.02,
        reason=DRIFTS,
        size=SIZE,
        stages=("cluster_lights",),
        camera="view",
    ),
    _scaled("scene scaled up", 1e6),
    _scaled("scene scaled down", 1e-6),
    Failure(
        name="scene moved away",
        knob="distance of the scene from the origin",
        unit="extents away",
        easy=1.0,
        hard=1e5,
        scene=lambda distance: similar(_room(0), shift=(2 * distance, -2 * distance, 2 * distance)),  # the room is 2 wide
        measure=transformed.change(_room(0)),
        quantity="mean change of the picture over its mean, same seed",
        truth="the picture at the origin",
        tolerance=0.01,
        reason=ROUNDS,
        stages=(),
    ),
    Failure(
        name="albedo towards 1",
        knob="albedo of a closed room that emits 1",
        unit="",
        easy=0.5,
        hard=0.99,
        logarithmic=False,
        scene=lambda albedo: scenes.furnace(albedo=albedo),
        measure=transformed.furnace_energy,
        quantity="energy ratio less 1",
        truth="closed form: sum of powers of the albedo up to the method's last reflection (row 1)",
        tolerance=0.05,
        reason="by choice 5 % of the light",
        stages=(),
    ),
)
