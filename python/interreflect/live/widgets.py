"""Knobs as a page's widgets: sliders, numbers, flags and choices; a technique's knobs lie in a folder beneath its name."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from typing import Any

from interreflect.catalogue import parse_value
from interreflect.live.knobs import Knob, knobs_of, method_of, walk, with_technique
from interreflect.methods.method import Method

APART = 0.15  # of a slider's length, between numbers beneath it
MOST_STEPS = 256  # whole numbers a slider can tell apart; knobs of more, or without an end, are typed


class KnobPanel:
    """The widgets of one method in a container of the page. `values` are as they stand there, whether or not they go together.

    changed: called when a value was turned. Widgets report from several threads, not always in order: what counts is what they hold.
    """

    def __init__(self, gui: Any, container: Any, method: Method, changed: Callable[[], None]) -> None:
        self._gui, self._container, self._changed = gui, container, changed
        self._groups: dict[str, Any] = {}  # that hold a technique's folder, by the technique's path
        self._folders: dict[str, Any] = {}  # of its knobs
        self._lock = threading.RLock()
        self._shown: list[Any] = []
        self.show(method)

    def show(self, method: Method) -> None:
        """The widgets of another method, or of other values."""
        with self._lock:
            for widget in self._shown:
                widget.remove()
            self._shown.clear()
            self._groups.clear()
            self._folders.clear()
            self.cls, self.values = type(method), method.knobs()
            with self._container:
                for knob in knobs_of(self.cls, self.values):
                    self._shown += self._add(knob)

    def method(self) -> Method:
        """ValueError and TypeError where the values do not go together."""
        return method_of(self.cls, self.values)

    def _add(self, knob: Knob) -> list[Any]:
        if knob.kind != "technique":
            return [self._plain(knob)]
        added = []
        if len(knob.choices) > 1:
            added.append(self._gui.add_dropdown(knob.name, knob.choices, initial_value=knob.value, hint=knob.hint))
            added[0].on_update(lambda event: self._choose(event, knob.path))
        self._groups[knob.path] = group = self._gui.add_folder(None)
        self._fill(knob)
        return [*added, group]

    def _fill(self, knob: Knob) -> None:
        """The knobs of a technique in place of those of the one before it."""
        before = self._folders.pop(knob.path, None)
        if before is not None:
            before.remove()  # and with it the folders inside
        self._folders = {path: folder for path, folder in self._folders.items() if not path.startswith(f"{knob.path}.")}
        if not knob.inner:
            return
        with self._groups[knob.path]:
            self._folders[knob.path] = folder = self._gui.add_folder(knob.value, expand_by_default=knob.path == "grid")
        with folder:
            for inner in knob.inner:
                self._add(inner)

    def _choose(self, event: Any, path: str) -> None:
        if event.client is None:  # set by us
            return
        with self._lock:
            self.values = with_technique(self.cls, self.values, path, event.target.value)
            self._fill(next(knob for knob in walk(knobs_of(self.cls, self.values)) if knob.path == path))
            self._changed()

    def _plain(self, knob: Knob) -> Any:
        label = f"{knob.name} ({knob.unit})" if knob.unit else knob.name
        if knob.kind == "flag":
            widget = self._gui.add_checkbox(label, knob.value, hint=knob.hint)
        elif knob.kind == "choice":
            widget = self._gui.add_dropdown(label, knob.choices, initial_value=knob.value, hint=knob.hint)
        elif knob.kind == "text":
            widget = self._gui.add_text(label, str(knob.value), hint=knob.hint)
        elif (step := slider_step(knob)) is not None:
            ends = (knob.minimum, knob.maximum) if knob.kind == "number" else (int(knob.minimum or 0), int(knob.maximum or 0))
            widget = self._gui.add_slider(label, *ends, step, knob.value, marks=marks(knob), hint=knob.hint)
        else:
            widget = self._gui.add_number(label, knob.value, step=1 if knob.kind == "integer" else None, hint=knob.hint)
        widget.on_update(lambda event: self._turn(event, knob))
        return widget

    def _turn(self, event: Any, knob: Knob) -> None:
        if event.client is None:  # set by us
            return
        with self._lock:
            value = event.target.value
            self.values = {**self.values, knob.path: parse_value(value) if knob.kind == "text" else value}
            self._changed()


def marks(knob: Knob) -> tuple[Any, ...]:
    """A slider's ends and its papers' values; those that would lie over another's number are dots alone."""
    low, high = knob.minimum or 0.0, knob.maximum or 0.0
    found: list[Any] = [(low, f"{low:g}"), (high, f"{high:g}")]
    numbered = [low, high]
    for value in sorted({value for _, value in knob.papers} - {low, high}):
        if min(abs(value - other) for other in numbered) > APART * (high - low):
            numbered.append(value)
            found.append((value, f"{value:g}"))
        else:
            found.append(value)
    return tuple(found)


def slider_step(knob: Knob) -> float | int | None:
    """A hundredth of a number's range in a round figure, 1 of whole numbers; None where a slider does not suit."""
    if knob.minimum is None or knob.maximum is None or not math.isfinite(knob.maximum - knob.minimum):
        return None
    span = knob.maximum - knob.minimum
    if span > MOST_STEPS or not knob.minimum <= knob.value <= knob.maximum:
        return None
    if knob.kind == "integer":
        return 1
    step: float = 10.0 ** math.floor(math.log10(span / 100))
    return step if math.isclose(knob.value / step, round(knob.value / step), abs_tol=1e-6) else None
