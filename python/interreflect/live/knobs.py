"""A method's knobs as a page shows them: a tree with range, unit and the papers' values; and back from their values to the method."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from interreflect import _core
from interreflect.catalogue import knob_range, range_of
from interreflect.methods.knobs import Range, flatten
from interreflect.methods.method import Method


@dataclass(frozen=True)
class Knob:
    """path: dotted, as `Method.knobs` has it. kind: "number", "integer", "flag", "choice", "technique", or "text" for a number that may be
    None. value: of a technique its class's name, as are its choices. papers: value of each preset that has such a knob."""

    path: str
    kind: str
    value: Any
    doc: str
    unit: str = ""
    interval: str = ""
    minimum: float | None = None
    maximum: float | None = None
    choices: tuple[str, ...] = ()
    papers: tuple[tuple[str, Any], ...] = ()
    inner: tuple[Knob, ...] = ()  # of the technique

    @property
    def name(self) -> str:
        return self.path.rpartition(".")[2]

    @property
    def hint(self) -> str:
        """What it means, its range, and what papers set it to."""
        about = ", ".join(text for text in (self.interval if not self.choices else "", self.unit) if text)
        papers = "; ".join(f"{preset}: {value}" for preset, value in self.papers)
        return ". ".join(text.rstrip(".") for text in (self.doc, about, papers) if text)


def knobs_of(cls: type[Method], values: Mapping[str, Any]) -> tuple[Knob, ...]:
    """The knobs of a method, field by field, at these values, whether or not they go together."""
    papers = {name: cls.preset(name).knobs() for name in cls.presets}
    return tuple(_of_field(field, values, papers) for field in dataclasses.fields(cls))  # type: ignore[arg-type]


def method_of(cls: type[Method], values: Mapping[str, Any]) -> Method:
    """The method whose `knobs()` these are. TypeError and ValueError as its constructor raises them."""
    fields: Any = dataclasses.fields(cls)  # type: ignore[arg-type]
    return cls(**{field.name: _made(field.name, values, _techniques_of(field)) for field in fields})


def with_technique(cls: type[Method], values: Mapping[str, Any], path: str, name: str) -> dict[str, Any]:
    """The values with another technique at a path, by its class's name or "None": its own knobs in place of those below it. They are as the
    method's defaults have them where these hold it, else as its own are."""
    plain = cls().knobs()
    if plain.get(path) == name:
        found = {key: value for key, value in plain.items() if key == path or key.startswith(f"{path}.")}
    else:
        found = dict(flatten({path: None if name == "None" else getattr(_core, name)()}))
    kept = {name: value for name, value in values.items() if name != path and not name.startswith(f"{path}.")}
    return {**kept, **found}


def walk(knobs: Sequence[Knob]) -> Iterator[Knob]:
    """Every knob, those of techniques after them."""
    for knob in knobs:
        yield knob
        yield from walk(knob.inner)


def _techniques_of(field: dataclasses.Field[Any]) -> tuple[type, ...]:
    """That a field may hold; none for plain knobs."""
    if isinstance(field.metadata.get("range"), Range):
        return ()
    found: tuple[type, ...] = _core.stages[field.name]["techniques"] if field.name in _core.stages else (type(field.default),)
    return found


def _of_field(field: dataclasses.Field[Any], values: Mapping[str, Any], papers: Mapping[str, Mapping[str, Any]]) -> Knob:
    limits = field.metadata.get("range")
    if not isinstance(limits, Range):
        doc = _core.stages[field.name]["doc"] if field.name in _core.stages else ""
        return _technique(field.name, _techniques_of(field), bool(field.metadata.get("optional")), doc, values, papers)
    kind = "choice" if limits.choices else "text" if limits.optional else _kind_of(type(field.default).__name__)
    return Knob(
        field.name, kind, values[field.name], limits.doc, limits.unit, range_of(limits), limits.minimum, limits.maximum,
        limits.choices, _papers(field.name, papers),
    )  # fmt: skip


def _of_param(path: str, param: Mapping[str, Any], values: Mapping[str, Any], papers: Mapping[str, Mapping[str, Any]]) -> Knob:
    if param["techniques"]:
        return _technique(path, param["techniques"], False, param["doc"], values, papers)
    kind = "choice" if param["choices"] else _kind_of(param["type"])
    return Knob(
        path, kind, values[path], param["doc"], param["unit"], knob_range(param), param["minimum"], param["maximum"],
        tuple(param["choices"]), _papers(path, papers),
    )  # fmt: skip


def _technique(
    path: str, known: Sequence[type], optional: bool, doc: str, values: Mapping[str, Any], papers: Mapping[str, Mapping[str, Any]]
) -> Knob:
    name = values[path]
    chosen: Any = {cls.__name__: cls for cls in known}.get(name)
    params = () if chosen is None else chosen.description["params"]
    # A paper's knobs count where it has this technique at this place.
    same = {preset: knobs for preset, knobs in papers.items() if knobs.get(path) == name}
    inner = tuple(_of_param(f"{path}.{param['name']}", param, values, same) for param in params)
    choices = (*(cls.__name__ for cls in known), *(("None",) if optional else ()))
    own = "" if chosen is None else f"{chosen.__name__}: {chosen.description['doc']}"
    about = " ".join(text for text in (doc, own) if text)
    return Knob(path, "technique", str(name), about, choices=choices, papers=_papers(path, papers), inner=inner)


def _papers(path: str, papers: Mapping[str, Mapping[str, Any]]) -> tuple[tuple[str, Any], ...]:
    return tuple((preset, knobs[path]) for preset, knobs in papers.items() if path in knobs)


def _kind_of(type_name: str) -> str:
    return {"bool": "flag", "int": "integer", "float": "number"}[type_name]


def _made(path: str, values: Mapping[str, Any], known: Sequence[type]) -> Any:
    value = values[path]
    if not known or value is None:
        return value
    technique: Any = {cls.__name__: cls for cls in known}[value]
    params = technique.description["params"]
    return technique(**{param["name"]: _made(f"{path}.{param['name']}", values, param["techniques"]) for param in params})
