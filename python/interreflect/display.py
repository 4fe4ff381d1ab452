"""How values show themselves in notebooks: tables in HTML."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from interreflect.methods.method import Method
    from interreflect.study.study import Study

ALIGNED = 'style="text-align: left"'


def rows(head: Sequence[str], body: Iterable[Sequence[Any]]) -> str:
    """A table; every cell is text."""
    top = "".join(f"<th {ALIGNED}>{escape(name)}</th>" for name in head)
    lines = ("<tr>" + "".join(f"<td {ALIGNED}>{escape(str(cell))}</td>" for cell in line) + "</tr>" for line in body)
    return f"<table><thead><tr>{top}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def technique(value: Any) -> str:
    """Name, meaning and source of a technique, and a row per knob: value, default, unit, range, meaning."""
    from interreflect.catalogue import knob_range

    told: Mapping[str, Any] = type(value).description
    source = ", ".join(text for text in (told["source"], told["place"]) if text)
    knobs = [(one["name"], getattr(value, one["name"]), one["default"], one["unit"], knob_range(one), one["doc"]) for one in told["params"]]
    table = rows(("knob", "value", "default", "unit", "range", "meaning"), knobs) if knobs else ""
    return f"<p><b>{escape(told['name'])}</b>: {escape(told['doc'])} [{escape(source)}]</p>{table}"


def method(value: Method) -> str:
    """A row per knob of a method, those that differ from its defaults marked."""
    plain = type(value)().knobs()
    body = [(name, knob, "" if plain.get(name) == knob else "changed") for name, knob in value.knobs().items()]
    bounces = "all bounces" if value.bounces is None else f"{value.bounces} indirect bounce{'' if value.bounces == 1 else 's'}"
    doc = (type(value).__doc__ or "").strip().partition("\n")[0]
    return f"<p><b>{escape(value.name)}</b>, {bounces}: {escape(doc)}</p>{rows(('knob', 'value', ''), body)}"


def study(value: Study) -> str:
    """The question, what is crossed with what, and how it is measured."""
    scenes = [(scene.name or scene.hash[:8], ", ".join(scene.cameras)) for scene in value.scenes]
    methods = [(one.name, ", ".join(f"{name}={knob}" for name, knob in one.knobs().items())) for one in value.methods]
    bounces = "all bounces" if value.bounces is None else f"bounces={value.bounces!r}"
    words = (
        f"{len(value.cells())} cells at {value.size[0]} x {value.size[1]}, seeds {', '.join(map(str, value.seeds))}, {bounces}; truth to "
        f"noise {value.reference.noise:g} or {value.reference.max_spp} samples; {value.repeats} to {value.max_repeats} timed repeats"
    )
    tables = rows(("scene", "cameras"), scenes) + rows(("method", "knobs"), methods)
    return f"<p><b>{escape(value.name)}</b>: {escape(words)}</p>{tables}"
