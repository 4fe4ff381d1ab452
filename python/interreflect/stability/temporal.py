"""How does a method behave in motion? Errors of each frame, jumps at surface points from frame to frame, response to a step."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.frame import Image
from interreflect.motion import Motion
from interreflect.progress import bar
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene
from interreflect.stability.not_finite import NotFinite
from interreflect.stability.reprojection import Origin, Surfaces, origin, surfaces
from interreflect.stability.response import StepResponse, response
from interreflect.study.reference import Reference, Truth, reference

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

Floats = NDArray[np.float64]
POP = 0.1  # of the truth's mean radiance: a surface point that jumps by more between two frames pops
SAMPLES = Reference(noise=1e-3, max_spp=512)


@dataclasses.dataclass(frozen=True, eq=False)
class Jumps:
    """Temporal errors of surface points and their statistics, NaN where there are none."""

    errors: Floats

    @property
    def mean(self) -> float:
        return float(self.errors.mean()) if self.errors.size else float("nan")

    @property
    def p95(self) -> float:
        return self._percentile(95)

    @property
    def p99(self) -> float:
        return self._percentile(99)

    @property
    def max(self) -> float:
        return self._percentile(100)

    def _percentile(self, share: float) -> float:
        return float(np.percentile(self.errors, share)) if self.errors.size else float("nan")


def jumps_of(errors: Sequence[Floats]) -> Jumps:
    """Those of all surface points that were seen before."""
    return Jumps(np.concatenate([error[np.isfinite(error)] for error in errors] or [np.empty(0)]))


@dataclasses.dataclass(frozen=True, eq=False)
class Played:
    """A method in motion, frame by frame, beside the truth of every frame.

    images, truths: (height, width, 3) each. errors: for every frame but the first, (height, width): temporal error at the surface point
    behind each pixel, |(t_i - t_{i-1}) - (r_i - r_{i-1})|, mean over channels, as a share of the truth's mean radiance over all frames;
    the values of frame i - 1 are those at the same surface point, bilinear between pixels, in picture and truth alike. NaN where that point
    was not seen before. truth_errors: the same made of the truth's own noise (half the difference of its halves).
    mean, p95, p99, max: of all of them. pops: surface points that jump by more than `pop`. flicker: for a motion in which nothing
    moves, standard deviation of a pixel over the frames, mean over pixels, as a share of the mean radiance; else NaN.
    response: for a motion that switches a light, how the picture's mean follows; else None.
    """

    method: str
    scene: str
    motion: Motion
    images: Sequence[Image]
    truths: Sequence[Image]
    noises: Sequence[float]
    errors: Sequence[Floats]
    truth_errors: Sequence[Floats]
    milliseconds: Sequence[float]
    pop: float

    @cached_property
    def jumps(self) -> Jumps:
        """Temporal errors of all frames."""
        return jumps_of(self.errors)

    @cached_property
    def truth_jumps(self) -> Jumps:
        """Those that the truth's own noise makes: below them, `jumps` say nothing."""
        return jumps_of(self.truth_errors)

    @property
    def mean(self) -> float:
        return self.jumps.mean

    @property
    def p95(self) -> float:
        return self.jumps.p95

    @property
    def p99(self) -> float:
        return self.jumps.p99

    @property
    def max(self) -> float:
        return self.jumps.max

    @property
    def pops(self) -> int:
        return int((self.jumps.errors > self.pop).sum())

    @property
    def points(self) -> int:
        """Surface points compared, over all frames."""
        return int(self.jumps.errors.size)

    @property
    def flicker(self) -> float:
        if not self.motion.is_still:
            return float("nan")
        spread = np.std(np.asarray(self.images, np.float64), axis=0).mean()
        return float(spread / np.mean(self.truths))

    @property
    def response(self) -> StepResponse | None:
        if self.motion.switch is None:
            return None
        return response([float(np.mean(image, dtype=np.float64)) for image in self.images], self.motion.switch[0])

    @cached_property
    def table(self) -> pd.DataFrame:
        """A row per frame: relMSE and energy ratio, its truth's noise, and the temporal error to the frame before."""
        import pandas as pd

        rows = []
        for k, (image, truth) in enumerate(zip(self.images, self.truths, strict=True)):
            row = {"frame": k, "milliseconds": self.milliseconds[k], "relmse": metrics.relmse(image, truth)}
            row |= {"energy_ratio": metrics.energy_ratio(image, truth), "noise": self.noises[k]}
            rows.append(row | (self._jumps_of(k) if k else {}))
        return pd.DataFrame(rows).set_index("frame")

    def _jumps_of(self, frame: int) -> dict[str, float]:
        jumps, noise = (jumps_of(errors[frame - 1 : frame]) for errors in (self.errors, self.truth_errors))
        return {
            "temporal_mean": jumps.mean, "temporal_p95": jumps.p95, "temporal_p99": jumps.p99, "temporal_max": jumps.max,
            "pops": int((jumps.errors > self.pop).sum()), "points": int(jumps.errors.size), "truth_temporal_mean": noise.mean,
        }  # fmt: skip

    def chart(self, dark: bool = False) -> Figure:
        """Temporal error and relMSE over the frames."""
        from interreflect.charts.motion import curves

        return curves([self], dark)

    def filmstrip(self, frames: int = 6, dark: bool = False) -> Figure:
        """Pictures, truths and temporal errors of some frames."""
        from interreflect.charts.motion import filmstrip

        return filmstrip(self, frames, dark)

    def __repr__(self) -> str:
        words = f"temporal error mean {self.mean:.3g}, p95 {self.p95:.3g}, p99 {self.p99:.3g}, max {self.max:.3g}; {self.pops} pops"
        tail = f"; flicker {self.flicker:.3g}" if self.motion.is_still else ""
        return f"<{self.method} on {self.scene}: {words} in {self.points} points; truth's own {self.truth_jumps.mean:.2g}{tail}>"

    def _repr_html_(self) -> str:
        from html import escape

        return f"<p>{escape(repr(self)[1:-1])}</p>{self.table.to_html(float_format=lambda number: f'{number:.4g}')}"


def motion(
    method: Any,
    scene: Scene,
    motion: Motion,
    size: tuple[int, int] = (160, 120),
    seed: int = 0,
    threads: int | None = None,
    reference: Reference = SAMPLES,
    pop: float = POP,
    bounces: int | Literal["method"] | None = "method",
) -> Played:
    """Plays a motion with a method, history passed on, and compares every frame with its own truth.

    reference: how good each frame's truth must be; truths are kept in the cache folder. pop: share of the mean radiance. bounces:
    indirect bounces of the truth; None: all; "method": the method's own.
    ValueError where the scene lacks what moves, and for a frame with numbers that are not finite.
    """
    return compare(list(method.prepare(scene, threads).play(motion, size, seed)), method, scene, motion, size, reference, pop, bounces)


def compare(
    frames: Sequence[Any],
    method: Any,
    scene: Scene,
    motion: Motion,
    size: tuple[int, int],
    wanted: Reference = SAMPLES,
    pop: float = POP,
    bounces: int | Literal["method"] | None = "method",
) -> Played:
    """Frames of a motion that were rendered already, beside the truth. NotFinite, a ValueError, for a picture with such numbers."""
    for k, frame in enumerate(frames):
        if wrong := int(frame.image.size - np.isfinite(frame.image).sum()):
            raise NotFinite(f"frame {k} holds {wrong} numbers that are not finite", frame.image)
    views = [motion.at(scene, k) for k in range(motion.frames)]
    carried = method.bounces if bounces == "method" else bounces
    with bar(views, desc="truths", unit="frame", leave=False) as progress:
        truths = [frame_truth(moved, camera, size, carried, wanted) for moved, camera in progress]
    seen = [surfaces(moved, camera, size) for moved, camera in views]
    scale = float(np.mean([truth.image.mean(dtype=np.float64) for truth in truths]))
    errors, own = [], []
    for k in range(1, motion.frames):
        way = origin(seen[k], seen[k - 1])
        change = _change(way, truths[k].image, truths[k - 1].image)
        errors.append(_error(way, _change(way, frames[k].image, frames[k - 1].image) - change, scale))
        halves = [(truth.halves[0] - truth.halves[1]) / 2 for truth in truths[k - 1 : k + 1]]
        own.append(_error(way, _change(way, halves[1], halves[0]), scale) if truths[k].key != truths[k - 1].key else 0 * errors[-1])
    return Played(
        method=method.name,
        scene=scene.name,
        motion=motion,
        images=[frame.image for frame in frames],
        truths=[truth.image for truth in truths],
        noises=[truth.noise for truth in truths],
        errors=errors,
        truth_errors=own,
        milliseconds=[frame.profile.milliseconds for frame in frames],
        pop=pop,
    )


def frame_truth(scene: Scene, camera: Camera, size: tuple[int, int], bounces: int | None, wanted: Reference) -> Truth:
    """The truth of a view whose camera the scene does not hold."""
    shown = scene.replace(cameras={"moving": camera})
    return reference(shown, "moving", size, bounces, wanted.noise, wanted.max_spp)


def _change(way: Origin, now: NDArray[np.floating], before: NDArray[np.floating]) -> Floats:
    return np.asarray(now, np.float64) - way.fetch(before)


def _error(way: Origin, change: Floats, scale: float) -> Floats:
    error: Floats = np.where(way.found, np.abs(change).mean(2), np.nan)
    return error / scale if scale > 0 else np.where(error == 0, 0.0, np.inf)


__all__ = ["POP", "Played", "Surfaces", "compare", "frame_truth", "motion"]
