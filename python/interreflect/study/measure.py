"""Measure one cell: its truth, its preparation, its timed renders, its errors. Runs in a worker process."""

from __future__ import annotations

import dataclasses
import math
import pickle
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from typing import Any

import numpy as np

import interreflect.cache as cache
from interreflect import metrics
from interreflect.methods.pieces import Pieces
from interreflect.progress import told_to
from interreflect.study.calibration import Calibration, calibrate
from interreflect.study.interface import Frame, Method, Prepared, Scene
from interreflect.study.locks import Claims, machine
from interreflect.study.memory import give_back, peak_bytes, reset_peak, resident_bytes
from interreflect.study.messages import Phase, Pictures, Reply, Request
from interreflect.study.records import FAILED, NOT_FINITE, OK
from interreflect.study.reference import Truth, reference
from interreflect.study.sources import package_digest
from interreflect.study.timing import measure

CALIBRATION_SECONDS = 900.0  # clocks and neighbours of a machine change
Metric = Callable[[Any, Any], float]
Changes = dict[str, Any]  # fields of a record
ON_IMAGE: dict[str, Metric] = {
    "relmse": metrics.relmse,
    "trimmed_relmse": metrics.trimmed_relmse,
    "energy_ratio": metrics.energy_ratio,
    "flip": metrics.flip,
    "ssim": metrics.ssim,
    "hue_shift": metrics.hue_shift,
}
ON_INDIRECT: dict[str, Metric] = {
    "indirect_relmse": metrics.relmse,
    "indirect_trimmed_relmse": metrics.trimmed_relmse,
    "indirect_energy_ratio": metrics.energy_ratio,
}


class Bench:
    """Measures cells one by one; keeps the scene, the truths, the preparation and its pieces at hand, and nothing of earlier
    scenes."""

    def __init__(self, say: Callable[[Phase | Pictures], None], await_go: Callable[[], object]) -> None:
        self._say, self._await_go = say, await_go
        self._scene: tuple[str, Scene] | None = None
        self._truths: dict[str, Truth] = {}
        self._calibrations: dict[int | None, tuple[float, Calibration]] = {}  # threads -> when, what
        self._prepared: tuple[bytes, Prepared, float] | None = None  # pickled method, preparation, its peak of memory
        self._pieces = Pieces()  # of the methods measured one after the other that share some
        _load_libraries()
        give_back()
        self.idle = resident_bytes()

    def forget_truths(self) -> None:
        self._truths = {}

    def measure(self, request: Request) -> Reply:
        """What is to be said of the cell; what fails is said in words."""
        if request.code != package_digest():
            return Reply({}, refused="the worker's package has other sources than the study's: start Python anew, install it on every host")
        changes: Changes = {"images": request.images}
        try:
            scene = self._take_scene(request)
            truth = self._truth(scene, request)
        except KeyboardInterrupt:
            return Reply({}, interrupted=True)
        except Exception as error:
            return Reply({"status": FAILED, "failure": f"reference: {_words(error)}"})
        changes |= {"noise": truth.noise, "indirect_noise": truth.indirect_noise, "truth": truth.key, "truth_spp": truth.spp}
        calibration = None
        try:
            with self._turn("prepare", alone=request.repeats > 0):
                if request.repeats > 0:
                    calibration = request.calibration or self._calibrate(request.threads)
                    changes["calibration"] = calibration.key
                frame = self._render(scene, request, changes)
            with self._turn("metrics", alone=False):
                if request.images:
                    self._say(_pictures(frame, truth, request.truth_wanted))
                changes |= compare(frame, truth)
        except KeyboardInterrupt:
            return Reply({}, interrupted=True)
        except Exception as error:
            return Reply(changes | {"status": FAILED, "failure": _words(error), "images": False}, calibration)
        return Reply(changes, calibration)

    def _calibrate(self, threads: int | None) -> Calibration:
        """Once a run, or rather once a quarter of an hour and number of threads."""
        known = self._calibrations.get(threads)
        if known is None or time.monotonic() - known[0] > CALIBRATION_SECONDS:
            self._say(Phase("calibrate"))
            known = (time.monotonic(), calibrate(threads))
            self._calibrations[threads] = known
            self._say(Phase("prepare"))
        return known[1]

    def _take_scene(self, request: Request) -> Scene:
        if request.scene is not None:
            self._scene = self._prepared = None
            self._pieces = Pieces()
            self._truths = {}
            give_back()
            self._scene = (request.scene_key, pickle.loads(request.scene))
        if self._scene is None or self._scene[0] != request.scene_key:
            raise RuntimeError("the worker was not given the scene")
        return self._scene[1]

    def _truth(self, scene: Scene, request: Request) -> Truth:
        wanted = request.reference
        if request.truth not in self._truths:
            with self._first_in_line(request.truth), self._turn("truth", alone=False), told_to(self._far):
                self._truths[request.truth] = reference(
                    scene, request.camera, request.size, request.bounces, wanted.noise, wanted.max_spp, threads=request.threads
                )
        return self._truths[request.truth]

    def _far(self, words: str) -> None:
        self._say(Phase("truth", words))

    @contextmanager
    def _first_in_line(self, truth: str) -> Iterator[None]:
        """Where another process makes this truth, wait for it: then it lies in the cache. Without a cache each makes its own."""
        with ExitStack() as stack:
            with suppress(OSError):
                claims = Claims(cache.folder())
                stack.callback(claims.close)
                claims.wait_for(truth)
            yield

    @contextmanager
    def _turn(self, phase: str, alone: bool) -> Iterator[None]:
        """The machine for a phase that is timed (`alone`) or not."""
        with machine(alone, waiting=lambda: self._say(Phase("turn"))):
            self._say(Phase(phase))
            yield

    def _render(self, scene: Scene, request: Request, changes: Changes) -> Frame:
        prepared, peak = self._prepare(scene, request)
        changes["precompute_milliseconds"] = float(prepared.precompute_milliseconds)
        self._say(Phase("render"))
        counted = reset_peak()
        frame, timing = measure(
            lambda: prepared.render(request.camera, size=request.size, seed=request.seed, threads=request.threads),
            request.repeats,
            request.max_repeats,
            before_clock=self._before_clock,
        )
        held = max(peak, peak_bytes()) - self.idle if counted else math.nan
        changes |= {"peak_memory_bytes": held, **dataclasses.asdict(timing)}
        return frame

    def _before_clock(self) -> None:
        self._say(Phase("go"))
        self._await_go()

    def _prepare(self, scene: Scene, request: Request) -> tuple[Prepared, float]:
        """The method's preparation, kept for the next camera or seed, and the peak of memory while it was made."""
        if self._prepared is None or self._prepared[0] != request.method:
            last_peak = 0.0 if self._prepared is None else self._prepared[2]
            self._prepared = None  # the memory of the last one is free before the next one takes its own
            method: Method = pickle.loads(request.method)
            shares = bool(getattr(method, "pieces_key", ()))
            if not shares:
                self._pieces = Pieces()
            give_back()
            reset_peak()
            more = {"pieces": self._pieces} if shares else {}
            prepared = method.prepare(scene, threads=request.threads, **more)
            # Pieces taken as they are: the peak while they were made counts, the last cell's at most.
            taken = self._pieces.saved_milliseconds > 0
            self._prepared = (request.method, prepared, max(peak_bytes(), last_peak) if taken else peak_bytes())
        return self._prepared[1:]


def compare(frame: Frame, truth: Truth) -> Changes:
    """Status and metrics of a picture; a metric that this picture cannot have is NaN, with the reason as a warning."""
    image, indirect = frame.image, frame.indirect
    if image.shape != truth.image.shape:
        raise ValueError(f"the picture's shape must be {truth.image.shape}, got {image.shape}")
    wrong = sum(int(light.size - np.count_nonzero(np.isfinite(light))) for light in (image, indirect))
    if wrong:
        return {"status": NOT_FINITE, "failure": f"{wrong} numbers of the picture are not finite"}
    pairs = [(name, metric, image, truth.image) for name, metric in ON_IMAGE.items()]
    pairs += [(name, metric, indirect, truth.indirect) for name, metric in ON_INDIRECT.items()]
    values, reasons = {}, []
    for name, metric, light, target in pairs:
        try:
            values[name] = metric(light, target)
        except ValueError as error:
            values[name] = math.nan
            reasons.append(f"{name}: {error}")
    return {"status": OK, "metrics": values, "warnings": tuple(reasons)}


def _pictures(frame: Frame, truth: Truth, truth_wanted: bool) -> Pictures:
    of_truth = (truth.key, (truth.image, truth.indirect)) if truth_wanted else None
    return Pictures((np.asarray(frame.image), np.asarray(frame.indirect)), of_truth)


def _load_libraries() -> None:
    """Load what the metrics need, lest it be counted as the first cell's memory."""
    grey = np.full((16, 16, 3), 0.5, np.float32)
    for metric in ON_IMAGE.values():
        metric(grey, grey)


def _words(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
