"""Light where none can be: through walls, on convex bodies, in an umbra; and sky that is missing. Truths in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.builtin.blade import ALBEDO as BLADE_FLOOR
from interreflect.scenes.builtin.blocked_sky import ALBEDO as SKY_FLOOR
from interreflect.scenes.builtin.blocked_sky import sky_share
from interreflect.scenes.builtin.dark_room import ALBEDO as ROOM_WALLS
from interreflect.scenes.builtin.lone_ball import lone_ball
from interreflect.scenes.builtin.penumbra import ALBEDO as PENUMBRA_FLOOR
from interreflect.scenes.builtin.penumbra import SEEN as PENUMBRA_SEEN
from interreflect.scenes.builtin.penumbra import irradiance, penumbra_width
from interreflect.stability.failure import Reading, Trial
from interreflect.stages import trace_gbuffer

PLACES = (0.0, 0.0047, 0.0083, 0.0129)  # extents: near 0, .3, .5 and .8 of a voxel of a grid of 64


def leak(trial: Trial) -> Reading:
    """Mean radiance that the camera "dark" sees over that which "lit" sees; the truth is 0."""
    dark, lit = trial.render("dark"), trial.render("lit")
    return Reading(_share(dark.image, lit.image), dark.image, np.zeros_like(dark.image))


def sky_inside(trial: Trial) -> Reading:
    """Mean radiance in a closed room under a sky of 1, over its albedo; the truth is 0."""
    frame = trial.render()
    return Reading(_mean(frame.image) / ROOM_WALLS, frame.image, np.zeros_like(frame.image))


def leak_on_body(trial: Trial, body: str) -> Reading:
    """The same of a body's pixels alone: light that caches around it carry through the wall."""
    scene = trial.scene
    own = trace_gbuffer(scene, "dark", trial.size).body == list(scene.bodies).index(body)
    dark, lit = trial.render("dark"), trial.render("lit")
    return Reading(_share(dark.image[own], lit.image), dark.image, np.zeros_like(dark.image))


def occlusion(trial: Trial, blocker: str) -> Reading:
    """Occlusion of the sky at a point, picture minus truth: positive where too much is hidden."""
    frame = trial.render("point")
    share = _mean(frame.image) / SKY_FLOOR  # radiance of a floor under a sky of radiance 1 is its albedo times what it sees
    signed = sky_share(blocker, trial.value) - share
    return Reading(abs(signed), trial.render("view").image, signed=signed)


def self_illumination(trial: Trial) -> Reading:
    """Indirect over direct light of a convex body, mean over four places within a voxel; the truth is 0."""
    frames = [trial.render(scene=lone_ball(radius=trial.value, shift=shift)) for shift in PLACES]
    return Reading(float(np.mean([_share(frame.indirect, frame.direct) for frame in frames])), frames[0].indirect, frames[0].image)


def false_shadow(trial: Trial) -> Reading:
    """Share of light that is wrong, in the umbra of a blade and in as much lit floor beside it; the edge's own two columns left out."""
    frame = trial.render()
    width = trial.size[0]
    column = (np.arange(width) + 0.5) / width * 2 - 1  # -1 left, 1 right; the edge of the shadow is at 0
    clear = np.abs(column) > 2.5 / width
    truth = np.broadcast_to(np.where(column > 0, BLADE_FLOOR, 0.0)[None, :, None], frame.image.shape).astype(np.float32)
    wrong = np.abs(frame.image - truth)[:, clear]
    return Reading(_mean(wrong) / BLADE_FLOOR, frame.image, truth)


def penumbra_error(trial: Trial) -> Reading:
    """Mean over a penumbra and its surroundings of |column mean - truth|, over the fully lit radiance."""
    frame = trial.render()
    width, height = trial.size
    half = PENUMBRA_SEEN * penumbra_width(trial.value) / 2
    x = ((np.arange(width) + 0.5) / width * 2 - 1) * half
    z = ((np.arange(height) + 0.5) / width * 2 - height / width) * half
    truth = PENUMBRA_FLOOR / np.pi * irradiance(trial.value, x[None, :], z[:, None])
    error = np.abs(frame.image.mean(2).mean(0) - truth.mean(0)).mean() / truth.max()
    return Reading(float(error), frame.image, np.repeat(truth[..., None], 3, axis=2).astype(np.float32))


def _mean(image: NDArray[np.floating]) -> float:
    return float(np.mean(image, dtype=np.float64))


def _share(part: NDArray[np.floating], whole: NDArray[np.floating]) -> float:
    """Mean over mean; infinite where the whole, which must be lit, is black."""
    return _mean(part) / _mean(whole) if _mean(whole) > 0 else float("inf")
