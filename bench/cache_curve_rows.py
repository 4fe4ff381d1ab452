"""How distribution grows with the picture and creation with the caches: in proportion, if a pixel and a cone always cost the same."""

from __future__ import annotations

from typing import Any

import interreflect as ir
from bench.cache_pipeline import CAMERA, Cars, steps_of
from bench.calibration import Calibration
from bench.rows import Row
from bench.timing import least, timed
from interreflect import stages

REPEATS = 7
SHARES = (0.25, 0.5, 1.0, 1.414)  # of the picture's width
CACHES = (1024, 2048, 4096, 8192)
RESOLUTIONS = (8, 16, 32)
UNEVEN = 1.5  # of the cost of one to that of another, where a stage is linear


def rows(calibration: Calibration, cars: Cars) -> list[Row]:
    return [distribution(cars), *(creation(cars, resolution) for resolution in RESOLUTIONS)]


def distribution(cars: Cars) -> Row:
    """As many caches wanted of every picture."""
    sizes = [(round(share * cars.size[0]), round(share * cars.size[1])) for share in SHARES]
    seen = [stages.trace_gbuffer(cars.scene, CAMERA, size) for size in sizes]
    spent = least(*(timed(lambda g=g: stages.distribute(cars.method.distribute, g, cars.scene)) for g in seen), repeats=REPEATS)
    each = {f"{w} x {h}": 1e6 * ms / (w * h) for (w, h), ms in zip(sizes, spent, strict=True)}
    return _linear("distribution over pixels", spent[SHARES.index(1.0)], "ns a pixel", each)


def creation(cars: Cars, resolution: int) -> Row:
    """Cones of one width: how many steps they take depends on it."""
    wanted: list[Any] = [ir.Clustered(caches=caches) for caches in CACHES]
    places = [stages.distribute(one, cars.gbuffer, cars.scene) for one in wanted]
    technique = cars.method.fill.replace(resolution=resolution)
    spent = least(*(timed(lambda p=p: stages.fill(technique, p, cars.pyramid, cars.scene)) for p in places), repeats=REPEATS)
    texels = [len(p) * resolution**2 for p in places]
    steps = steps_of(stages.fill(technique, places[-1], cars.pyramid, cars.scene)) / texels[-1]
    each = {f"{len(p)} caches": 1e6 * ms / n for p, ms, n in zip(places, spent, texels, strict=True)}
    note = f"{steps:.1f} steps a cone, {list(each.values())[-1] / steps:.2f} ns a step"
    return _linear(f"creation over caches of {resolution} x {resolution}", spent[-1], "ns a texel", each, note)


def _linear(name: str, milliseconds: float, unit: str, each: dict[str, float], note: str = "") -> Row:
    listed = "; ".join(f"{what}: {cost:.1f}" for what, cost in each.items())
    uneven = max(each.values()) / min(each.values())
    target, met = f"at most {UNEVEN:g}x as long for one as for another", uneven <= UNEVEN
    full = f"{unit}: {listed}; {uneven:.2f}x" + (f"; {note}" if note else "")
    return Row(name, milliseconds, None, None, None, target, met, note=full, details={unit: each})
