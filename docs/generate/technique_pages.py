"""The page of a technique, and that of a stage, as Markdown: from their descriptions, notes and what was measured."""

from __future__ import annotations

from typing import Any

import interreflect as ir
from docs.generate import measured
from docs.generate.notes import Notes, notes_of
from docs.generate.settings import GRID, Setting, main_knob, methods_with, setting_of
from interreflect import _core
from interreflect.catalogue import knob_range

DRAWN = "Drawn by `./run docs`."
SHOWN = {"image": "all light", "direct": "direct light", "indirect": "indirect light"}


def technique_page(technique: Any) -> str:
    name, described = technique.__name__, technique.description
    notes, setting = notes_of("techniques", name), setting_of(technique)
    parts = [
        f"# {name}",
        f"{described['doc']} Stage {' and '.join(stage_link(stage) for stage in technique.stages)}.",
        picture(name, setting),
        " ".join(notes.sentences),
        "## Knobs",
        knob_table(described["params"]),
        code(technique, setting),
        "## Paper and equation",
        source(described, notes),
        "## Exact counterpart",
        "\n\n".join(counterpart(technique, stage) for stage in technique.stages),
        *cost_and_error(technique, notes),
        "## Where it breaks",
        breaks(technique),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def picture(name: str, setting: Setting) -> str:
    caption = (
        f"Left: `{setting.scene_name}` by {method_link(setting.method)} with `{setting.path}={name}()`{told(name, setting)}. "
        f"Middle: the path-traced truth. Right: where their {SHOWN[setting.part]} differs, from a relative squared error of 0.0001 (black) "
        f"to 1 (bright). {DRAWN}"
    )
    return f":::{{figure}} ../pictures/{name}.png\n:alt: {name}, the truth, and where they differ\n\n{caption}\n:::"


def told(name: str, setting: Setting) -> str:
    """Knobs that are not the method's usual ones, and frames before the one that is shown."""
    usual = type(setting.method)().replace({setting.path: getattr(ir, name)()}).knobs()
    other = {path: value for path, value in setting.method.knobs().items() if usual.get(path) != value and path != setting.path}
    heads = {path: value for path, value in other.items() if path.rpartition(".")[0] not in other or path in usual}
    words = ", ".join(f"`{path}={value}`" for path, value in heads.items())
    return (f", {words}" if words else "") + ("" if setting.frames == 1 else f", the last of {setting.frames} frames")


def code(technique: Any, setting: Setting) -> str:
    knob = main_knob(technique)
    given = f"{knob[0]}={getattr(technique(), knob[0])!r}" if knob and "." not in knob[0] else ""
    method = f"ir.methods.{type(setting.method).__name__}()"
    lines = (
        "import interreflect as ir",
        "",
        f"technique = ir.{technique.__name__}({given})",
        f'method = {method}.replace({{"{setting.path}": technique}})',
    )
    return "```python\n" + "\n".join(lines) + "\n```"


def source(described: Any, notes: Notes) -> str:
    work, place = described["source"], described["place"]
    if work == "Interreflect":
        told_by = "It stands in no paper: it is the stage done without approximation, to compare with."
    else:
        told_by = f"{work}{', ' + place if place else ''}."
    return f"{told_by}\n\n{notes.rest}".strip()


def counterpart(technique: Any, stage: str) -> str:
    exact = _core.stages[stage]["exact"]
    if exact is None:
        return f"{stage_link(stage)} has none: {notes_of('stages', stage).head.get('bypass', 'it is a choice without a truth of its own')}."
    if technique is exact:
        return f"It is the exact counterpart of {stage_link(stage)} itself: what the others are compared with."
    return (
        f"Of {stage_link(stage)}: {technique_link(exact)}. `ir.exact(ir.{technique.__name__}())` returns it, and `ir.attribute` puts it in "
        "this technique's place to tell what the approximation costs."
    )


def cost_and_error(technique: Any, notes: Notes) -> list[str]:
    name, knob = technique.__name__, main_knob(technique)
    if knob is None:
        return ["## Cost and error", notes.head.get("unmeasured", "It has no number to sweep.")]
    head = f"## Cost and error against `{knob[0]}`"
    curve = measured.curve_of(name)
    if curve is None:
        return [head, f"Not measured yet; `.venv/bin/python -m docs.measure {name}` does it."]
    caption = (
        f"Work and time relative to the default, and error, against `{knob[0]}`; mean of {curve.seeds} seeds. "
        f"{curve.made}. Made by `{curve.command}`, drawn by `./run docs`."
    )
    return [head, *two_themes(f"../charts/{name}", f"cost and error of {name} against {knob[0]}", caption)]


def two_themes(path: str, alt: str, caption: str) -> list[str]:
    """The same figure for light and dark pages; one of them is shown."""
    return [
        f":::{{figure}} {path}-{theme}.svg\n:alt: {alt}\n:figclass: only-{theme}\n\n{caption}\n:::" for theme in ("light", "dark")
    ]


def breaks(technique: Any) -> str:
    stages = technique.stages
    aimed = [row for row in ir.stability.failures if set(row.stages) & set(stages)]
    rows = measured.breaks_of(technique.__name__)
    if not aimed:
        return "No failure scene aims at this stage alone; [those that concern every stage](../failures.md) apply."
    table = ["| Failure | Swept | Tolerance | Breaks at |", "|---|---|---|---|"]
    for row in aimed:
        point = rows.get(row.name, "not measured")
        swept = f"{row.knob}{', ' + row.unit if row.unit else ''}, {number(row.easy)} to {number(row.hard)}"
        table.append(f"| [{row.name}](../failures.md) | {cell(swept)} | {row.tolerance:g} | {point} |")
    return "\n".join(table) + f"\n\n{measured.breaks_made()}"


def knob_table(params: Any, prefix: str = "") -> str:
    if not params:
        return "It has none."
    rows = ["| Knob | Default | Unit | Range | Meaning |", "|---|---|---|---|---|"]
    for knob in params:
        cells = (f"`{prefix}{knob['name']}`", f"`{knob['default']!r}`", knob["unit"], knob_range(knob), knob["doc"])
        rows.append("| " + " | ".join(cell(text) for text in cells) + " |")
    return "\n".join(rows)


def number(value: float) -> str:
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.3g}"


def cell(text: str) -> str:
    return text.replace("|", "\\|").replace("<", "&lt;").replace("\n", " ")


def stage_page(stage: str) -> str:
    described, notes = _core.stages[stage], notes_of("stages", stage)
    exact = described["exact"]
    rows = [
        f"| {technique_link(cls)}{', exact' if cls is exact else ''} | {cell(cls.description['doc'])} | {cell(cls.description['source'])} |"
        for cls in described["techniques"]
    ]
    field = f"grid.{stage}" if stage in GRID else stage
    users = ", ".join(method_link(getattr(ir.methods, name)()) for name in methods_with(stage))
    hidden = "\n".join(f"../techniques/{cls.__name__}" for cls in described["techniques"] if cls.stages[0] == stage)
    parts = [
        f"# {stage}",
        " ".join(notes.sentences) or described["doc"],
        "\n".join(["| Technique | What it does | Source |", "|---|---|---|", *rows]),
        f"The knob is `{field}`, of {users}." if users else "",
        "" if exact else f"It has no exact counterpart: {notes.head.get('bypass', 'it is a choice without a truth of its own')}.",
        notes.rest,
        f"```python\nimport interreflect as ir\n\nfor technique in ir.techniques({stage!r}):\n    print(technique())\n```",
        f"```{{toctree}}\n:hidden:\n\n{hidden}\n```" if hidden else "",
    ]
    return "\n\n".join(part for part in parts if part) + "\n"


def stage_link(stage: str) -> str:
    return f"[`{stage}`](../stages/{stage}.md)"


def technique_link(technique: Any) -> str:
    return f"[`{technique.__name__}`](../techniques/{technique.__name__}.md)"


def method_link(method: Any) -> str:
    return f"[`{type(method).__name__}`](../methods/{type(method).__name__}.md)"
