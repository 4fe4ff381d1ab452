"""The page of a method: what it is, its pipeline, its picture beside the truth, presets and knobs."""

from __future__ import annotations

import inspect
from functools import cache
from typing import Any

import interreflect as ir
from docs.generate.notes import notes_of
from docs.generate.settings import GRID, Setting
from docs.generate.technique_pages import DRAWN, cell, technique_link, two_themes
from interreflect import _core
from interreflect.catalogue import method_rows
from interreflect.methods.knobs import is_technique


def setting_of(name: str) -> Setting:
    """The method with its defaults on the built-in atrium."""
    head = notes_of("methods", name).head
    method = getattr(ir.methods, name)().replace(head.get("knobs", {}))
    return Setting(method, head.get("scene", "atrium"), head.get("camera"), "", "indirect", head.get("frames", 1))


def method_page(name: str) -> str:
    cls, notes = getattr(ir.methods, name), notes_of("methods", name)
    parts = [
        f"# {name}",
        (inspect.getdoc(cls) or "").replace("\n\n", "\n\n"),
        " ".join(notes.sentences),
        "## Pipeline",
        "\n\n".join(two_themes(f"../pipelines/{name}", f"the stages of {name}", f"The stages of a frame, in order. {DRAWN}")),
        "## What it looks like",
        picture(name),
        notes.rest,
        "## Stages and techniques",
        stages(cls()),
        "## Knobs",
        knobs(cls.__name__),
        code(cls),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def picture(name: str) -> str:
    setting = setting_of(name)
    caption = (
        f"Left: the built-in {setting.scene_name} by `{name}`. Middle: the path-traced truth of as many bounces. Right: where their "
        f"indirect light differs, from a relative squared error of 0.0001 (black) to 1 (bright). {DRAWN}"
    )
    return f":::{{figure}} ../pictures/{name}.png\n:alt: {name}, the truth, and where they differ\n\n{caption}\n:::"


def stages(method: Any) -> str:
    rows = ["| Stage | By default | Others |", "|---|---|---|"]
    held = {**method.exact_knobs(), **{name: None for name, value in method.knobs().items() if value is None and name in _core.stages}}
    if hasattr(method, "grid"):
        held |= {name: getattr(method.grid, name) for name in GRID}
    for name, value in held.items():
        if name in _core.stages:
            others = [technique_link(cls) for cls in _core.stages[name]["techniques"] if not isinstance(value, cls)]
            chosen = technique_link(type(value)) if is_technique(value) else "left out"
            rows.append(f"| [`{name}`](../stages/{name}.md) | {chosen} | {', '.join(others)} |")
    return "\n".join(rows) if len(rows) > 2 else "It has none to choose."


@cache
def _rows() -> list[tuple[str, ...]]:
    return method_rows()


def knobs(name: str) -> str:
    """Its plain knobs; those of techniques stand on their pages."""
    kebab = getattr(ir.methods, name)().name
    names = [row[0] for row in _rows()]
    start = names.index(kebab) + 1
    end = next((index for index in range(start, len(names)) if names[index]), len(names))
    plain = [row for row in _rows()[start:end] if row[2] != "technique"]
    if not plain:
        return "Its techniques' alone."
    lines = [f"| `{row[1]}` | `{row[5]}` | {row[3]} | {cell(row[4])} | {cell(row[6])} |" for row in plain]
    return "\n".join(["| Knob | Default | Unit | Range | Meaning |", "|---|---|---|---|---|", *lines])


def code(cls: Any) -> str:
    lines = ["import interreflect as ir", "", f"method = ir.methods.{cls.__name__}()"]
    told = ""
    if cls.presets:
        told = f"## Presets\n\nThe papers' configurations are values: {', '.join(f'`{name}`' for name in cls.presets)}.\n\n"
        lines += [f"paper = ir.methods.{cls.__name__}.preset({cls.presets[0]!r})", "print(paper.knobs())"]
    return told + "```python\n" + "\n".join(lines) + "\n```"
