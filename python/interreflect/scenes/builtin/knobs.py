"""Knobs of built-in scenes: one description of each serves range check, message, docstring and the command line's list."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec, get_type_hints

from interreflect.scenes.checks import FLOAT_MAX, choice, nearest_name, number, whole
from interreflect.scenes.values import Scene

Knobs = ParamSpec("Knobs")


@dataclass(frozen=True)
class Knob:
    """What a knob may be: a number in [minimum, maximum], or one of `choices`; with meaning and unit."""

    doc: str
    minimum: float = -math.inf
    maximum: float = math.inf
    open_minimum: bool = False
    unit: str = ""
    choices: tuple[str, ...] = ()

    def check(self, argument: str, value: object, kind: object) -> object:
        """`value` as a float, int or str. ValueError names argument, bound and value."""
        if kind is str:
            return choice(argument, value, self.choices)
        if kind is int:
            return whole(argument, value, int(self.minimum), int(self.maximum))
        return number(argument, value, max(self.minimum, -FLOAT_MAX), min(self.maximum, FLOAT_MAX), open_low=self.open_minimum)

    @property
    def range(self) -> str:
        """As in messages: [0, 1], or the choices."""
        if self.choices:
            return ", ".join(map(repr, self.choices))
        low = "(-inf" if self.minimum == -math.inf else f"{'(' if self.open_minimum else '['}{self.minimum:g}"
        return f"{low}, inf)" if self.maximum == math.inf else f"{low}, {self.maximum:.15g}]"


def built_in(make: Callable[Knobs, Scene]) -> Callable[Knobs, Scene]:
    """A scene function whose parameters are `Annotated[type, Knob(...)]`: checked, told in its docstring, and the scene's name."""
    described = _described(make)
    signature = inspect.signature(make)

    @wraps(make)
    def checked(*args: Knobs.args, **kwargs: Knobs.kwargs) -> Scene:
        for name in kwargs:
            if name not in described:
                raise TypeError(f"{make.__name__} has no knob {name!r}{nearest_name(name, described)}")
        bound = signature.bind(*args, **kwargs)
        bound.apply_defaults()
        for name, (kind, knob) in described.items():
            bound.arguments[name] = knob.check(f"{make.__name__}.{name}", bound.arguments[name], kind)
        told = ", ".join(f"{name}={_plain(value)}" for name, value in bound.arguments.items())
        return make(*bound.args, **bound.kwargs).replace(name=f"{make.__name__}({told})")

    plain = [p.replace(annotation=described[name][0]) for name, p in signature.parameters.items()]
    checked.__signature__ = signature.replace(parameters=plain, return_annotation=Scene)  # type: ignore[attr-defined]
    lines = [f"{name}: {knob.doc}; {knob.range}{' ' * bool(knob.unit)}{knob.unit}." for name, (_, knob) in described.items()]
    checked.__doc__ = "\n".join([inspect.getdoc(make) or "", "", *lines, "", "ValueError names the knob, its bound and its value."])
    return checked


def knobs_of(make: Callable[..., object]) -> dict[str, Knob]:
    """Name -> Knob of a built-in scene's parameters; those without one are left out."""
    return {name: knob for name, (_, knob) in _described(make).items()}


def _described(make: Callable[..., object]) -> dict[str, tuple[Any, Knob]]:
    hints = get_type_hints(inspect.unwrap(make), include_extras=True)
    return {
        name: (hint.__origin__, hint.__metadata__[0])
        for name, hint in hints.items()
        if isinstance(getattr(hint, "__metadata__", (None,))[0], Knob)
    }


def _plain(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else repr(value)
