"""Where does an error cross its tolerance? A sweep brackets the break point, bisection narrows it, noise widens it again."""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Callable, Sequence

import numpy as np

from interreflect.frame import Image
from interreflect.stability.failure import Failure, Reading

# Student's t, two-sided 95 %, by the number of seeds; beyond the table the last.
STUDENT = {2: 12.706, 3: 4.303, 4: 3.182, 5: 2.776, 6: 2.571, 7: 2.447, 8: 2.365, 9: 2.306, 10: 2.262}
BREAKS, NEVER, ALWAYS, REVERSED = "breaks", "never", "always", "reversed"


@dataclasses.dataclass(frozen=True, eq=False)
class Point:
    """The error at one value of the knob: mean over seeds, 95 % interval widened by the truth's own noise, and the first seed's picture."""

    value: float
    error: float
    low: float
    high: float
    signed: float
    image: Image
    truth: Image | None


@dataclasses.dataclass(frozen=True, eq=False)
class Crossing:
    """How the error behaved over the sweep.

    outcome: "breaks" (below at the easy end, above later), "never", "always" above, "reversed" (above at the easy end, below later).
    value: where the mean error first crosses the tolerance, NaN without. low, high: the nearest values on either side of it at which the
    error is surely below, or above, the tolerance. points: all that was measured, from easy to hard.
    before, after: the measured neighbours of the break point, easy side first; None where it does not cross. swept: the points of the
    first pass, at values that every method shares.
    """

    outcome: str
    value: float
    low: float
    high: float
    points: Sequence[Point]
    swept: Sequence[Point]
    before: Point | None
    after: Point | None
    words: str


def point_of(value: float, readings: Sequence[Reading]) -> Point:
    """Readings of several seeds at one value."""
    errors = np.array([reading.error for reading in readings])
    mean, floor = float(errors.mean()), max(reading.floor for reading in readings)
    spread = 0.0
    if len(errors) > 1 and np.isfinite(errors).all():
        spread = STUDENT.get(len(errors), 2.0) * float(errors.std(ddof=1)) / math.sqrt(len(errors))
    signed = float(np.mean([reading.signed for reading in readings]))
    first = readings[0]
    return Point(value, mean, max(0.0, mean - spread - floor), mean + spread + floor, signed, first.image, first.truth)


def find(row: Failure, measure: Callable[[float], Point], sweep: int = 6, bisections: int = 4) -> Crossing:
    """Sweeps the knob at `sweep` values, then halves the first bracket `bisections` times."""
    swept = [measure(value) for value in row.values(sweep)]
    points = list(swept)
    above = [point.error > row.tolerance for point in points]
    index = next((k for k in range(len(above) - 1) if above[k] != above[k + 1]), None)
    if index is None:
        return _without(row, points, above[0])
    before, after = points[index], points[index + 1]
    for _ in range(bisections):
        middle = measure(row.between(before.value, after.value))
        points.append(middle)
        if (middle.error > row.tolerance) == (before.error > row.tolerance):
            before = middle
        else:
            after = middle
    points.sort(key=lambda point: row.share(point.value))
    low, high = _interval(row, points, before, after)
    times = sum(a != b for a, b in itertools.pairwise(above))
    words = "above at the easy end, below from there on" if above[0] else ""
    if times > 1:
        words = f"{words}; crosses {times} times".removeprefix("; ")
    outcome = REVERSED if above[0] else BREAKS
    return Crossing(outcome, _estimate(row, before, after), low, high, tuple(points), tuple(swept), before, after, words)


def _without(row: Failure, points: Sequence[Point], above: bool) -> Crossing:
    tolerance = row.tolerance
    if above:
        words = "always above"
        if any(point.low <= tolerance for point in points):
            words += ", though within noise at places"
    else:
        words = "never crosses"
        if any(point.high > tolerance for point in points):
            words += ", though noise reaches the tolerance"
    nan = math.nan
    return Crossing(ALWAYS if above else NEVER, nan, nan, nan, tuple(points), tuple(points), None, None, words)


def _estimate(row: Failure, before: Point, after: Point) -> float:
    """The knob at which the mean error is the tolerance, linear between two points along the sweep."""
    a, b = row.share(before.value), row.share(after.value)
    if not (math.isfinite(before.error) and math.isfinite(after.error)):
        return row.at((a + b) / 2)
    return row.at(a + (b - a) * (row.tolerance - before.error) / (after.error - before.error))


def _interval(row: Failure, points: Sequence[Point], before: Point, after: Point) -> tuple[float, float]:
    """From the break point outward on each side to the nearest value that is surely on that side of the tolerance, else to the end."""
    index = points.index(before)
    ends = [_sure(row, points[index::-1], before), _sure(row, points[index + 1 :], after)]
    return min(ends), max(ends)


def _sure(row: Failure, outward: Sequence[Point], nearest: Point) -> float:
    above = nearest.error > row.tolerance
    for point in outward:
        if point.low > row.tolerance if above else point.high < row.tolerance:
            return point.value
    return outward[-1].value
