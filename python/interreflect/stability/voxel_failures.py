"""Failures of voxels: leaks through walls, occlusion, injected light with gaps, layers that a march steps over."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from interreflect import scenes
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Failure
from interreflect.stability.measures import leaks, voxels

ZERO = "closed form: 0"
ONE_PER_CENT = "the table of failures asks for leaks under 1 %"
VOXEL = 1 / 64  # extents: of the grid whose voxels the sweeps are laid out for


def _between_rooms(name: str, **row: Any) -> Failure:
    return Failure(
        name=name,
        measure=leaks.leak,
        quantity="mean radiance of the dark room over that of the lit room",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("voxelize", "prefilter", "march"),
        **row,
    )


def _wall(name: str, **knobs: float) -> Failure:
    return _between_rooms(
        name,
        knob="thickness of the wall",
        unit="extents",
        easy=8 * VOXEL,
        hard=VOXEL / 8,
        scene=lambda t: scenes.thin_wall(thickness=t, **knobs),
    )


def _roof(name: str, scene: Callable[[float], Scene]) -> Failure:
    return Failure(
        name=name,
        knob="thickness of all walls",
        unit="extents",
        easy=8 * VOXEL,
        hard=VOXEL / 8,
        scene=scene,
        measure=leaks.sky_inside,
        quantity="share of the sky that is seen in a closed room",
        truth=ZERO,
        tolerance=0.01,
        reason=ONE_PER_CENT,
        stages=("march", "sky", "prefilter"),
        camera="dark",
    )


def _hidden_sky(blocker: str, name: str) -> Failure:
    return Failure(
        name=name,
        knob="distance of the blocker",
        unit="extents",
        easy=0.3,
        hard=0.01,
        scene=lambda d: scenes.blocked_sky(blocker, d),
        measure=lambda trial: leaks.occlusion(trial, blocker),
        quantity="hidden share of the sky, picture minus truth",
        truth="closed form: row 9" if blocker == "sphere" else "closed form: row 11 with a wall of finite length (Howell B-5)",
        tolerance=0.05,
        reason="by choice a twentieth of the sky, on top of the 2 % that the march's contract allows an open floor",
        stages=("march", "sky", "prefilter"),
        size=(32, 24),
    )


def _layer(name: str, corrected: bool) -> Failure:
    return Failure(
        name=name,
        knob="step of a ray through the voxels",
        unit="diameters",
        easy=0.125,
        hard=1.5,
        scene=lambda _: scenes.opaque_layer(),
        measure=lambda trial: voxels.open_layer(trial, corrected),
        quantity="largest share of the sun that comes through",
        truth=ZERO,
        tolerance=0.05,
        reason="a twentieth of the light; steps of half a diameter leave at most .035 of it, whole ones .25, by closed form",
        stages=("march",),
        camera="beside",
    )


VOXELS = (
    _wall("leak through a thin wall"),
    _wall("leak through a shifted wall", offset=VOXEL / 4),
    _wall("leak through a turned wall", rotation=30.0),
    _between_rooms(
        "leak through a wall at an angle",
        knob="turn of a wall half a voxel of a grid of 64 thick",
        unit="degrees",
        easy=0.0,
        hard=45.0,
        logarithmic=False,
        scene=lambda angle: scenes.thin_wall(thickness=VOXEL / 2, rotation=angle),
    ),
    _between_rooms(
        "leak through a wall off the grid",
        knob="shift of a wall half a voxel of a grid of 64 thick",
        unit="extents",
        easy=0.0,
        hard=VOXEL,
        logarithmic=False,
        scene=lambda shift: scenes.thin_wall(thickness=VOXEL / 2, offset=shift),
    ),
    _roof("sky through walls", lambda t: scenes.dark_room(thickness=t)),
    _roof("sky through turned walls", lambda t: scenes.dark_room(thickness=t, rotation=30.0, offset=VOXEL / 4)),
    _hidden_sky("sphere", "occlusion by a ball"),
    _hidden_sky("wall", "occlusion by a wall"),
    Failure(
        name="shadow map coarser than the voxels",
        knob="texels of the map that lights the voxels",
        unit="texels a voxel",
        easy=4.0,
        hard=1 / 8,
        scene=lambda _: scenes.sunlit_floor(),
        measure=voxels.injected_gaps,
        quantity="mean change of indirect light over its mean",
        truth="the picture whose voxels are lit by traced rays",
        tolerance=0.05,
        reason="by choice 5 % of the light; below a texel a voxel the share of dark ones is 1 - texels^2",
        stages=("light_voxels",),
        size=(48, 36),
    ),
    _layer("opaque layer between empty ones", corrected=False),
    _layer("opaque layer, opacity by the step's length", corrected=True),
)
