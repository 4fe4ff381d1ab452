"""Knobs of a method: fields that are techniques of the stage they are named as, or plain numbers, flags and words with a range."""

from __future__ import annotations

import dataclasses
import difflib
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from interreflect import _core


@dataclasses.dataclass(frozen=True)
class Range:
    """What a plain knob may be: numbers in [minimum, maximum] (or None where `optional`), or one of `choices`; with unit and meaning."""

    doc: str
    unit: str = ""
    minimum: float = -math.inf
    maximum: float = math.inf
    open_minimum: bool = False
    choices: tuple[str, ...] = ()
    optional: bool = False


def knob(default: Any, doc: str, **limits: Any) -> Any:
    """A plain knob with its default, meaning and range (see Range)."""
    return dataclasses.field(default=default, metadata={"range": Range(doc, **limits)})


def stage(default: Any, optional: bool = False) -> Any:
    """A technique of the stage that the field is named as; None leaves the stage out where it is optional."""
    return dataclasses.field(default=default, metadata={"optional": optional})


def is_technique(value: Any) -> bool:
    return hasattr(type(value), "description")


def check_knob(method: str, field: dataclasses.Field[Any], value: Any) -> None:
    """TypeError for a technique of another stage or a value of the wrong kind, ValueError for one out of range."""
    limits = field.metadata.get("range")
    if isinstance(limits, Range):
        _check_plain(f"{method}.{field.name}", limits, value, field.default)
    elif field.name in _core.stages:
        _check_technique(method, field, value)
    elif type(value) is not type(field.default):
        raise TypeError(f"{method}.{field.name} must be a {type(field.default).__name__}, got {value!r}")


def _check_technique(method: str, field: dataclasses.Field[Any], value: Any) -> None:
    allowed = _core.stages[field.name]["techniques"]
    if isinstance(value, allowed) or (value is None and field.metadata.get("optional")):
        return
    names = ", ".join(cls.__name__ for cls in allowed) + (" or None" if field.metadata.get("optional") else "")
    raise TypeError(f"{method}.{field.name} must be a technique of that stage ({names}), got {value!r}")


def _check_plain(name: str, limits: Range, value: Any, default: Any) -> None:
    if value is None and limits.optional:
        return
    if limits.choices:
        if value not in limits.choices:
            raise ValueError(f"{name} must be one of {', '.join(limits.choices)}, got {value!r}")
        return
    kinds: Any = (bool,) if isinstance(default, bool) else (int,) if isinstance(default, int) else (int, float)
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        raise TypeError(f"{name} must be {' or '.join(kind.__name__ for kind in kinds)}, got {value!r}")
    number = float(value)
    low = number > limits.minimum if limits.open_minimum else number >= limits.minimum
    if not (low and number <= limits.maximum and math.isfinite(number)):
        ends = f"{'(' if limits.open_minimum else '['}{limits.minimum:g}, {limits.maximum:g}]".replace("inf]", "inf)")
        raise ValueError(f"{name} must lie in {ends}{' ' + limits.unit if limits.unit else ''}, got {value!r}")


def flatten(values: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Dotted path and value of every knob: a technique gives its name under its own path, its knobs below it."""
    for name, value in values.items():
        if not is_technique(value):
            yield name, value
            continue
        yield name, type(value).__name__
        inner = {param["name"]: getattr(value, param["name"]) for param in type(value).description["params"]}
        yield from ((f"{name}.{path}", leaf) for path, leaf in flatten(inner))


def unknown(owner: str, name: str, known: list[str]) -> TypeError:
    """The TypeError for a knob that is not there, with the nearest one that is."""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"; did you mean {near[0]!r}?" if near else f"; it has {', '.join(known) or 'none'}"
    return TypeError(f"{owner} has no knob {name!r}{hint}")


def no_preset(owner: str, name: str, known: Sequence[str]) -> ValueError:
    """The ValueError for a preset that is not there, with the nearest one that is."""
    near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
    hint = f"; did you mean {near[0]!r}?" if near else f"; it has {', '.join(map(repr, known)) or 'none'}"
    return ValueError(f"{owner} has no preset {name!r}{hint}")


def replace_in(technique: Any, path: str, value: Any, owner: str, whole: str) -> Any:
    """A technique with the knob at `path` replaced. `owner` and `whole` are named by the TypeError for a path that leads nowhere."""
    head, _, rest = path.partition(".")
    known = [param["name"] for param in type(technique).description["params"]] if is_technique(technique) else []
    if head not in known:
        prefix = whole[: len(whole) - len(path)]
        raise unknown(owner, whole, [prefix + name for name in known])
    return technique.replace(**{head: replace_in(getattr(technique, head), rest, value, owner, whole) if rest else value})
