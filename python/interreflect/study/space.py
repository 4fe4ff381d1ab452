"""The space of a method's knobs: every plain knob of the method and of the techniques it holds, with the range to look at."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

from interreflect.methods.knobs import Range

REACH = 4.0  # a knob without given limits is looked at from a quarter of its value to four times it
TRANSPORT = ("bounces", "pixel", "milliseconds")  # what a picture is to show, and a budget: no choices of how well it is made


@dataclasses.dataclass(frozen=True)
class Axis:
    """A knob to vary: numbers from `low` to `high` (logarithmic where both are above 0), or `choices`."""

    path: str
    value: Any
    low: float = math.nan
    high: float = math.nan
    whole: bool = False
    choices: tuple[Any, ...] = ()

    @property
    def logarithmic(self) -> bool:
        return not self.choices and self.low > 0

    def at(self, place: float) -> Any:
        """The value at a place in [0, 1] of the range."""
        place = min(max(float(place), 0.0), 1.0)
        if self.choices:
            return self.choices[min(int(place * len(self.choices)), len(self.choices) - 1)]
        number = self.low * (self.high / self.low) ** place if self.logarithmic else self.low + place * (self.high - self.low)
        return round(number) if self.whole else min(max(number, self.low), self.high)

    def neighbours(self, factor: float) -> list[Any]:
        """Values beside the knob's own: over and times `factor` (at 0 or less, a tenth of the range away), or every other choice."""
        if self.choices:
            return [choice for choice in self.choices if choice != self.value]
        step = (self.high - self.low) / 10
        beside = [self.value / factor, self.value * factor] if self.value > 0 else [self.value - step, self.value + step]
        if self.whole:
            beside = [math.floor(beside[0]), math.ceil(beside[1])]
        return [value for value in beside if self.low <= value <= self.high and value != self.value]


def axes_of(method: Any, ranges: Mapping[str, Any] | None = None, knobs: Sequence[str] | None = None) -> list[Axis]:
    """An axis per plain knob of the method and of its techniques, in their order, but for what a picture is to show (`bounces`, `pixel`)
    and time budgets.

    ranges: path -> (low, high), or a list of choices; other numbers go from a quarter to four times their value, within what the knob
    allows (over all it allows, where the value is 0 or less). knobs: these paths only. TypeError for a path that is no plain knob.
    """
    found: dict[str, Axis] = {}
    for field in dataclasses.fields(method):
        value, limits = getattr(method, field.name), field.metadata.get("range")
        if isinstance(limits, Range):
            ends = (None if math.isinf(limits.minimum) else limits.minimum, None if math.isinf(limits.maximum) else limits.maximum)
            _add(found, field.name, value, ends, limits.open_minimum, limits.choices)
    for name, technique in method.exact_knobs().items():
        for param in type(technique).description["params"]:
            ends = (param["minimum"], param["maximum"])
            _add(found, f"{name}.{param['name']}", getattr(technique, param["name"]), ends, param["open_minimum"], param["choices"])
    for path, given in (ranges or {}).items():
        found[path] = _given(path, given, method)
    for path in (*(ranges or {}), *(knobs or ())):
        if path not in found or path not in method.knobs():
            raise TypeError(f"{type(method).__name__} has no plain knob {path!r}; it has {', '.join(found)}")
    return [axis for path, axis in found.items() if knobs is None or path in knobs]


def _add(
    found: dict[str, Axis], path: str, value: Any, ends: tuple[float | None, float | None], open_low: bool, choices: Sequence[str]
) -> None:
    if path.rpartition(".")[2] in TRANSPORT or value is None:
        return
    if isinstance(value, bool) or choices:
        found[path] = Axis(path, value, choices=tuple(choices) or (False, True))
        return
    if not isinstance(value, int | float):
        return
    low, high = ends
    if value > 0:
        near, far = value / REACH, value * REACH
        low, high = near if low is None or (open_low and low >= near) else max(low, near), far if high is None else min(high, far)
    if low is not None and high is not None and low < high:
        found[path] = Axis(path, value, float(low), float(high), isinstance(value, int))


def _given(path: str, given: Any, method: Any) -> Axis:
    value = method.knobs().get(path)
    if isinstance(given, tuple) and len(given) == 2:
        return Axis(path, value, float(given[0]), float(given[1]), isinstance(value, int) and not isinstance(value, bool))
    return Axis(path, value, choices=tuple(given))
