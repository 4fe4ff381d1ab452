"""What virtual lights let through, blur and lose; and how their clusters move.

Many sweep a knob of the method, not of the scene: a method without that knob is measured as it is.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import _core
from interreflect.frame import Image
from interreflect.motion import Motion
from interreflect.scenes.builtin.lit_patch import lit_patch
from interreflect.scenes.scene import Scene
from interreflect.stability.failure import Reading, Trial
from interreflect.stability.measures.moving import TRUTH
from interreflect.stability.temporal import compare
from interreflect.stages import cluster_lights, light_maps, sample_lights

Measure = Callable[[Trial], Reading]
Floats = NDArray[np.float64]
NONE = np.uint32(2**32 - 1)
ENDS = 8  # the first and the last eighth of an edge's picture are umbra and lit floor
EVERY = 17  # one lit texel in so many is asked
NEARBY = 2.0  # texels: a surface point that is further from all texels of the last map was not in it


def with_knob(path: str, measure: Measure, whole: bool = False) -> Measure:
    """`measure` of the method whose knob `path` has the swept value, rounded where it is a whole number."""

    def swept(trial: Trial) -> Reading:
        if path not in trial.method.knobs():
            return measure(trial)
        return measure(dataclasses.replace(trial, method=trial.method.replace({path: round(trial.value) if whole else trial.value})))

    return swept


def light_in_umbra(trial: Trial) -> Reading:
    """Mean indirect light in the umbra of `lit_patch`'s plate over that without the plate; the truth is 0."""
    shadowed, lit = trial.render().indirect, trial.render(scene=_opened(trial.scene)).indirect
    if not lit.mean() > 0:
        raise ValueError("the picture has no indirect light that a plate could hide")
    return Reading(float(shadowed.mean(dtype=np.float64) / lit.mean(dtype=np.float64)), shadowed, np.zeros_like(shadowed))


def penumbra_width(trial: Trial) -> Reading:
    """Width of an edge's penumbra over the truth's, less 1, whatever light its umbra holds."""
    open_trial = dataclasses.replace(trial, make=lambda _: _opened(trial.scene))
    frame, truth, lit_truth = trial.render(), trial.truth(), open_trial.truth()
    own, wanted = _width(frame.indirect, open_trial.render().indirect), _width(truth.indirect, lit_truth.indirect)
    half = _width(truth.halves[0] - truth.direct, lit_truth.halves[0] - lit_truth.direct)
    return Reading(abs(own / wanted - 1), frame.indirect, truth.indirect, own / wanted - 1, abs(half / wanted - 1))


def missing_light(trial: Trial) -> Reading:
    """Share of light that is missing where the truth's columns have half of their largest or more; light in excess makes up for none,
    nor does what leaks to where there should be none: it is interpolated from there and taken off."""
    frame, truth = trial.render(), trial.truth()
    wanted = _columns(truth.indirect)
    lit, dark = wanted > wanted.max() / 2, np.flatnonzero(wanted < wanted.max() / 100)

    def error(image: Image) -> float:
        found = _columns(image)
        leaked = np.interp(np.arange(len(found)), dark, found[dark]) if len(dark) else 0.0
        return float(np.maximum(wanted - (found - leaked), 0)[lit].mean() / wanted[lit].mean())

    return Reading(error(frame.indirect), frame.indirect, truth.indirect, floor=error(truth.halves[0] - truth.direct))


def profile_error(trial: Trial) -> Reading:
    """Mean of |column mean - truth's| over the truth's largest: the shape of a shadow across its edge."""
    frame, truth = trial.render(), trial.truth()
    wanted = _columns(truth.indirect)

    def error(image: Image) -> float:
        return float(np.abs(_columns(image) - wanted).mean() / wanted.max())

    return Reading(error(frame.indirect), frame.indirect, truth.indirect, floor=error(truth.halves[0] - truth.direct))


def jumps_without_history(step: Callable[[float], Motion], statistic: str) -> Measure:
    """As `moving.temporal`, every frame made as if it were the first."""

    def measure(trial: Trial) -> Reading:
        moving = dataclasses.replace(step(trial.value), camera=trial.camera)
        ready = trial.method.prepare(trial.scene, trial.threads)
        views = [moving.at(trial.scene, k) for k in range(moving.frames)]
        frames = [ready.render(camera, size=trial.size, seed=trial.seed + k, scene=scene) for k, (scene, camera) in enumerate(views)]
        played = compare(frames, trial.method, trial.scene, moving, trial.size, TRUTH)
        return Reading(getattr(played, statistic), played.images[-1], played.truths[-1], floor=getattr(played.truth_jumps, statistic))

    return measure


def churn(step: Callable[[float], Motion], history: bool) -> Measure:
    """Share of lit texels whose surface belonged to another light in the frame before, mean over frames; 0 where nothing is clustered.

    history: whether a frame's clusters go on where the last one's ended.
    """

    def measure(trial: Trial) -> Reading:
        image = trial.render().indirect
        if not _clusters(trial.method):
            return Reading(0.0, image)
        last: tuple[Any, _core.VirtualLights] | None = None
        changed = []
        for maps, lights in _played(trial, step(trial.value), history):
            if last is not None:
                changed.append(_changed((maps, lights), last))
            last = maps, lights
        return Reading(float(np.mean(changed)), image)

    return measure


def flux_error(step: Motion) -> Measure:
    """Root mean square over a turning light of the clusters' flux over that of their texels, less 1; 0 where nothing is clustered."""

    def measure(trial: Trial) -> Reading:
        image = trial.render().indirect
        if not _clusters(trial.method):
            return Reading(0.0, image)
        ratios = [
            float(lights.flux.sum(dtype=np.float64) / sum(one.flux.sum(dtype=np.float64) for one in maps.maps))
            for maps, lights in _played(trial, step, history=False)
        ]
        return Reading(float(np.sqrt(np.mean(np.square(np.array(ratios) - 1)))), image, signed=float(np.mean(ratios)) - 1)

    return measure


def _opened(scene: Scene) -> Scene:
    """The lit patch and its floor without what hangs between, seen by the same camera."""
    return lit_patch("none").replace(cameras=scene.cameras)


def _columns(image: Image) -> Floats:
    return np.asarray(image.mean((0, 2), dtype=np.float64))


def _width(image: Image, lit: Image) -> float:
    """Width of the ramp with the same integral of v (1 - v), a sixth of it, as a share of the picture; v: from umbra (0) to lit (1)."""
    visible = _columns(image) / _columns(lit)
    end = len(visible) // ENDS
    low, high = visible[:end].mean(), visible[-end:].mean()
    if not high > low:
        raise ValueError("the picture has no shadow of an edge")
    v = (visible - low) / (high - low)
    return float(6 * (v * (1 - v)).mean())


def _clusters(method: Any) -> bool:
    return bool(method.knobs().get("cluster_lights") == "KMeans")


def _played(trial: Trial, motion: Motion, history: bool) -> Iterator[tuple[_core.LightMaps, _core.VirtualLights]]:
    """Light maps and clusters of a motion, frame by frame."""
    method, last = trial.method, None
    for k in range(motion.frames):
        maps = light_maps(motion.at(trial.scene, k)[0], method.map_size, method.emitter_views)
        seeds = sample_lights(method.sample_lights, maps, trial.seed + k)
        last = cluster_lights(method.cluster_lights, seeds, maps, last if history else None, trial.seed + k)
        yield maps, last


def _changed(now: tuple[Any, _core.VirtualLights], before: tuple[Any, _core.VirtualLights]) -> float:
    """Share of the lit texels of the first map, seen before too, whose surface belonged to a light of another number."""
    from scipy.spatial import cKDTree

    (places, labels, spacing), (old_places, old_labels, _) = (_lit(*one) for one in (now, before))
    places, labels = places[::EVERY], labels[::EVERY]
    distance, nearest = cKDTree(old_places).query(places)
    seen = distance < NEARBY * spacing
    return float((labels[seen] != old_labels[nearest[seen]]).mean())


def _lit(maps: _core.LightMaps, lights: _core.VirtualLights) -> tuple[Floats, NDArray[np.uint32], float]:
    """Positions (n, 3) of the first map's texels that send light on, the numbers of their lights, and how far apart texels are."""
    one, labels = maps.maps[0], lights.cluster[0]
    lit = labels != NONE
    return np.asarray(one.position, np.float64)[lit], labels[lit], float(np.sqrt(np.median(one.area[lit])))
