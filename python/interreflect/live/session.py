"""What one client looks at: what it wishes for, the last frame made for it, and the truth beside it. Knows no page."""

from __future__ import annotations

import dataclasses
import math
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.live.comparison import Errors, Flip, compare, compared, measure_flip
from interreflect.live.layers import LAYERS
from interreflect.live.seen import Seen, see
from interreflect.live.shared import Shared
from interreflect.live.truth import RefiningTruth
from interreflect.methods.method import Method
from interreflect.scenes.camera import Camera

Bytes = NDArray[np.uint8]


@dataclass(frozen=True)
class Wish:
    """layer: of LAYERS. comparison: of comparison.COMPARISONS; all but the first need `refines`. exposure: stops above middle grey for
    the mean of the first picture. truth_bounces: "method" for as many as the method aims at, or "all". plays: frames follow each other at
    rest too."""

    method: Method
    camera: Camera
    size: tuple[int, int]
    layer: str = "image"
    exposure: float = 0.0
    comparison: str = "method"
    refines: bool = False
    truth_bounces: str = "method"
    plays: bool = False


@dataclass(frozen=True, eq=False)
class Picture:
    """(height, width, 3) bytes for the page, and what it says beside them. milliseconds: of drawing, without the frame."""

    pixels: Bytes
    seen: Seen
    milliseconds: float
    errors: Errors | None


class Session:
    """`wish` may be replaced by any thread; `step` is for one thread alone."""

    def __init__(self, shared: Shared, wish: Wish) -> None:
        self.shared = shared
        self._lock = threading.Lock()
        self._wish = wish
        self._met: Wish | None = None  # the wish that was last tried
        self._failed: Wish | None = None  # the last that could not be met
        self._seen: Seen | None = None
        self._seed = 0
        self._middle: float | None = None  # stops that bring the first picture's mean to middle grey
        self._drawn: tuple[tuple[Seen, str, float], Bytes] | None = None  # of which frame, which layer, at which exposure
        self._truth: RefiningTruth | None = None
        self._flip: Flip | None = None  # the last that was measured

    @property
    def wish(self) -> Wish:
        return self._wish

    def change(self, **changes: Any) -> None:
        """Another wish; what was not begun of the one before it is dropped."""
        with self._lock:
            self._wish = dataclasses.replace(self._wish, **changes)

    @property
    def is_stale(self) -> bool:
        """Whether a picture is to be made."""
        return self._wish != self._met or (self._wish.plays and self._wish != self._failed)

    @property
    def may_refine(self) -> bool:
        """Whether a better truth is wanted of what is shown."""
        wish, seen = self._met, self._seen
        if wish is None or seen is None or not wish.refines or wish == self._failed:
            return False
        truth = self._truth_of(wish, seen)
        return not truth.is_done or not self._has_flip(wish, seen, truth)

    def step(self) -> Picture:
        """The picture that is wished for. ValueError and the like where it cannot be made; it is not tried again then."""
        wish, last = self._wish, self._met
        self._met = wish
        with self._noting_failure(wish):
            seen = self._seen
            if seen is None or self._is_other_frame(wish, last, seen):
                self._seen = seen = self._render(wish, seen)
            return self._draw(wish, seen)

    def refine(self) -> Picture:
        """The same picture beside a better truth, or measured against it by FLIP where that is due."""
        seen, wish = self._seen, self._met
        if seen is None or wish is None:
            raise ValueError("there is no frame yet")
        with self._noting_failure(wish):
            truth = self._truth_of(wish, seen)
            if truth.latest is None or (self._has_flip(wish, seen, truth) and not truth.is_done):
                truth.refine()
            else:
                self._flip = measure_flip(seen.frame, truth.latest, wish.layer)
            return self._draw(wish, seen)

    def _has_flip(self, wish: Wish, seen: Seen, truth: RefiningTruth) -> bool:
        found, latest = self._flip, truth.latest
        return found is not None and latest is not None and found.holds(seen.frame, wish.layer, latest.spp)

    @contextmanager
    def _noting_failure(self, wish: Wish) -> Iterator[None]:
        try:
            yield
        except Exception:
            self._failed = wish
            raise

    @staticmethod
    def _is_other_frame(wish: Wish, last: Wish | None, seen: Seen) -> bool:
        if last is None or wish.plays:
            return True
        same = (wish.method, wish.camera, wish.size) == (seen.prepared.method, seen.camera, seen.size)
        return not same or not set(LAYERS[wish.layer].stages) <= set(seen.results)

    def _render(self, wish: Wish, before: Seen | None) -> Seen:
        same = before is not None and (before.prepared.method, before.size) == (wish.method, wish.size)
        history = before.frame.history if before is not None and same else None
        seen = see(self.shared.prepared(wish.method), wish.camera, wish.size, self._seed, history, LAYERS[wish.layer].stages)
        self._seed = (self._seed + 1) % 2**32
        return seen

    def _draw(self, wish: Wish, seen: Seen) -> Picture:
        start = time.perf_counter()
        if self._middle is None:
            mean = float(np.nan_to_num(seen.frame.image, nan=0.0, posinf=0.0).mean(dtype=np.float64))
            self._middle = math.log2(metrics.MIDDLE_GREY / mean) if mean > 0 else 0.0
        stops = wish.exposure + self._middle
        if self._drawn is None or self._drawn[0] != (seen, wish.layer, stops):
            self._drawn = (seen, wish.layer, stops), LAYERS[wish.layer].draw(seen, stops)
        pixels = self._drawn[1]
        truth = self._truth_of(wish, seen).latest if wish.refines else None
        errors = None if truth is None else compare(seen.frame, truth, wish.layer, self._flip)
        if errors is not None and truth is not None:
            pixels = compared(pixels, errors, truth, wish.layer, wish.comparison, stops)
        return Picture(pixels, seen, 1e3 * (time.perf_counter() - start), errors)

    def _truth_of(self, wish: Wish, seen: Seen) -> RefiningTruth:
        """That of the frame that is shown: what was traced counts as long as the view and its bounces stay."""
        bounces = seen.prepared.method.bounces if wish.truth_bounces == "method" else None
        view = (seen.camera, seen.size, bounces)
        if self._truth is None or (self._truth.camera, self._truth.size, self._truth.bounces) != view:
            self._truth = RefiningTruth(self.shared.scene, *view, threads=self.shared.threads)
        return self._truth
