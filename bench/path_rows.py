"""Path tracing beside Mitsuba 3 and Cycles: the time to reach their error, and the time of one sample."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from bench import cycles_peer, limits, mitsuba_peer
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.mitsuba_peer import PeerMissing
from bench.rows import Row, absent, times_sooner, within
from bench.sponza import SIZE, Sponza, as_peers_render_it

Picture = NDArray[np.float32]
Render = Callable[[int], tuple[Picture, float]]  # seed -> picture, milliseconds
SEEDS = 5
SPP = 4


@dataclasses.dataclass(frozen=True)
class Measured:
    """Least milliseconds of a picture and the mean relative variance of its pixels."""

    milliseconds: float
    variance: float
    mean: float


def rows(calibration: Calibration, sponza: Sponza | None) -> list[Row]:
    found = [*_cornell_rows()]
    if sponza is None:
        names = ("path tracing, one bounce", "path tracing, all bounces")
        return [*found, *(absent(f"{name}: Sponza", "3x sooner than the peer, per sample in time", "Sponza is not here") for name in names)]
    scene = as_peers_render_it(sponza.scene)
    found += _sponza_rows("path tracing, one bounce", scene, calibration, 1, 350)
    found += _sponza_rows("path tracing, all bounces", scene, calibration, None, 900)
    return [*found, _cycles_row(scene)]


def _cornell_rows() -> list[Row]:
    name, size = "Cornell box, one bounce, equal error", (512, 512)
    scene = ir.scenes.cornell_box()
    return [_against_mitsuba(name, scene, size, 1, 16, 2.0, None)[0]]


def _sponza_rows(name: str, scene: ir.Scene, calibration: Calibration, bounces: int | None, bound: float) -> list[Row]:
    mean_bounces = bounces_of_paths(scene, bounces)
    limit = limits.path_sample(calibration, SIZE[0] * SIZE[1], mean_bounces)
    scale = limit / limits.path_sample(TARGETS_MACHINE, SIZE[0] * SIZE[1], mean_bounces)
    equal, ours = _against_mitsuba(f"{name}: equal error", scene, SIZE, bounces, SPP, 3.0, limit)
    return [equal, within(f"{name}: a sample", ours.milliseconds / SPP, limit, bound, scale)]


def _against_mitsuba(
    name: str, scene: ir.Scene, size: tuple[int, int], bounces: int | None, spp: int, times: float, sample_limit: float | None
) -> tuple[Row, Measured]:
    """The row of equal error, and what ours measured."""
    ours = renderer(scene, size, bounces, spp)
    peer = f"Mitsuba 3 llvm, {spp} samples"
    try:
        theirs = mitsuba_peer.renderer(scene, next(iter(scene.cameras)), size, bounces, spp)
    except PeerMissing as missing:
        return absent(name, f"{times:g}x sooner than the peer", str(missing), peer), compared(ours)[0]
    a, b = compared(ours, clocked(theirs))
    return equal_error(name, a, b, peer, times, None if sample_limit is None else sample_limit * spp), a


def equal_error(name: str, ours: Measured, theirs: Measured, peer: str, times: float, limit: float | None) -> Row:
    """Ours: the time to reach the peer's error. Error falls with the number of samples, so time x variance is what counts."""
    share = ours.variance / theirs.variance
    details = {"ours": dataclasses.asdict(ours), "peer": dataclasses.asdict(theirs)}
    sooner = theirs.milliseconds / (ours.milliseconds * share)
    variances = f"relative variance {ours.variance:.3g} and {theirs.variance:.3g}"
    note = f"{sooner:.2f}x sooner: pictures in {ours.milliseconds:.0f} and {theirs.milliseconds:.0f} ms, {variances}"
    note += f", means {ours.mean:.4g} and {theirs.mean:.4g}"
    return times_sooner(
        name,
        ours.milliseconds * share,
        None if limit is None else limit * share,
        peer,
        theirs.milliseconds,
        times,
        note=note,
        details=details,
    )


def bounces_of_paths(scene: ir.Scene, bounces: int | None) -> float:
    """How many rays a path has after its primary one, in the mean: absorption, the open roof and roulette end it early."""
    counts = ir.methods.PathTracing(spp=1, bounces=bounces).render(scene, size=SIZE).profile.stages["path_trace"].counts
    return counts["rays"] / counts["paths"] - 1


def renderer(scene: ir.Scene, size: tuple[int, int], bounces: int | None, spp: int) -> Render:
    """Ours, ready: seed -> picture, box-filtered as the peers' are."""
    prepared = ir.methods.PathTracing(spp=spp, bounces=bounces, pixel="box").prepare(scene)
    return clocked(lambda seed: prepared.render(size=size, seed=seed).image)


def clocked(call: Callable[[int], Picture]) -> Render:
    """The picture and the wall time that it took."""

    def render(seed: int) -> tuple[Picture, float]:
        start = time.perf_counter()
        picture = call(seed)
        return picture, 1e3 * (time.perf_counter() - start)

    return render


def compared(*renderers: Render) -> list[Measured]:
    """Each renderer's time and variance over the same seeds, in turn, after a warm-up.

    Variance is relative to one brightness for all: the mean over all pictures and 8 x 8 pixels, squared, plus a hundredth of the
    picture's mean squared. A pixel's own mean of so few samples would follow its own fireflies and hide them.
    """
    for render in renderers:
        render(SEEDS)
    times: list[list[float]] = [[] for _ in renderers]
    pictures: list[list[Picture]] = [[] for _ in renderers]
    for seed in range(SEEDS):
        for k, render in enumerate(renderers):
            picture, spent = render(seed)
            times[k].append(spent)
            pictures[k].append(np.asarray(picture, np.float32))
    mean = smoothed(np.mean([np.mean(some, 0) for some in pictures], 0))
    scale = mean**2 + 0.01 * float(mean.mean()) ** 2
    return [
        Measured(min(spent), float((np.var(some, 0, ddof=1) / scale).mean()), float(np.mean(some)))
        for spent, some in zip(times, pictures, strict=True)
    ]


def smoothed(picture: Picture, side: int = 8) -> Picture:
    """Every pixel the mean of its block; the picture's sides must be multiples of `side`."""
    height, width, channels = picture.shape
    blocks = picture.reshape(height // side, side, width // side, side, channels).mean((1, 3))
    return blocks.repeat(side, 0).repeat(side, 1)


def _cycles_row(scene: ir.Scene) -> Row:
    name, target, peer = "path tracing, one bounce: Cycles", "3x sooner than the peer", f"Cycles, {SPP} samples"
    try:
        theirs = cycles_peer.renderer(scene, "nave", SIZE, SPP)
    except PeerMissing as missing:
        return absent(name, target, str(missing), peer)
    a, b = compared(renderer(scene, SIZE, 1, SPP), theirs)
    return equal_error(name, a, b, peer, 3.0, None)
