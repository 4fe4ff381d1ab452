"""What exists, found by name or listed in rows: scenes, methods, techniques, study files. The command line reads from here."""

from __future__ import annotations

import ast
import dataclasses
import difflib
import inspect
import runpy
import traceback
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

Row = tuple[str, ...]  # name, knob, type, unit, range, default, meaning


def scene_rows() -> list[Row]:
    """A row per built-in scene, and one per knob of it."""
    from interreflect import scenes
    from interreflect.scenes.builtin.knobs import knobs_of

    rows: list[Row] = []
    for name in dir(scenes):
        function = getattr(scenes, name)
        rows.append((name, "", "", "", "", "", _first_line(function)))
        described = knobs_of(function)
        for knob in inspect.signature(function).parameters.values():
            default = "required" if knob.default is knob.empty else repr(knob.default)
            limits = described.get(knob.name)
            if limits:
                kind = "choice" if limits.choices else type(knob.default).__name__
                rows.append(("", knob.name, kind, limits.unit, range_of(limits), default, limits.doc))
            else:
                rows.append(("", knob.name, str(knob.annotation), "", "", default, _line_about(function, knob.name)))
    return rows


def method_rows() -> list[Row]:
    """A row per method, and one per field: a plain knob, or a stage with the techniques it takes."""
    from interreflect import methods
    from interreflect.methods.knobs import Range

    rows: list[Row] = []
    for method in (getattr(methods, name) for name in dir(methods)):
        rows.append((_kebab(method.__name__), "", "", "", "", "", _first_line(method)))
        for field in dataclasses.fields(method):
            limits = field.metadata.get("range")
            if isinstance(limits, Range):
                kind = "choice" if limits.choices else str(field.type)
                rows.append(("", field.name, kind, limits.unit, range_of(limits), repr(field.default), limits.doc))
            else:
                rows.append(("", field.name, "technique", "", "", repr(field.default), _choices_of(field.name)))
                if not _choices_of(field.name):  # no stage lists its knobs
                    held: Any = type(field.default)
                    rows += [_knob_row(knob, f"{field.name}.") for knob in held.description["params"]]
    return rows


def technique_rows(stage: str | None = None) -> list[Row]:
    """A row per technique of every stage (or of one), and one per knob. ValueError for an unknown stage."""
    from interreflect import _core
    from interreflect.stages import techniques

    rows: list[Row] = []
    for name in [stage] if stage else list(_core.stages):
        for technique in techniques(name):
            described = technique.description  # type: ignore[attr-defined]
            source = f" [{described['source']}]" if described.get("source") else ""
            rows.append((f"{name}: {technique.__name__}", "", "", "", "", "", described["doc"] + source))
            rows += [_knob_row(knob) for knob in described["params"]]
    return rows


def find_scene(name: str) -> Any:
    """A built-in scene by name, with knobs if given (`cornell_box(light="spot")`), or a scene file."""
    from interreflect import scenes
    from interreflect.scenes.load import load_scene

    head = name.partition("(")[0]
    if head in dir(scenes):
        made = getattr(scenes, head)(**_call(name)[1])
        return getattr(made, "scene", made)  # a closed form holds its scene
    if not Path(name).suffix and not Path(name).exists():
        raise ValueError(f"there is no built-in scene {name!r}{_nearest(name, dir(scenes))}; a scene file has an extension")
    return load_scene(name)


def scene_code(name: str) -> str:
    """The Python expression for what `find_scene` finds by this name."""
    from interreflect import scenes

    head = name.partition("(")[0]
    if head not in dir(scenes):
        return f"ir.load_scene({name!r})"
    return f"ir.scenes.{name if '(' in name else f'{name}()'}"


def find_method(name: str) -> Any:
    """A method with default knobs by its kebab-case or class name. ValueError with the nearest name."""
    from interreflect import methods

    known = {_kebab(found): found for found in dir(methods)}
    found = known.get(name, name if name in known.values() else None)
    if found is None:
        raise ValueError(f"there is no method {name!r}{_nearest(name, known)}; there are {', '.join(known)}")
    return getattr(methods, found)()


def parse_knobs(settings: Iterable[str]) -> dict[str, Any]:
    """["grid.resolution=64", "prefilter=SurfaceCoverage()"] as knob path -> value. ValueError names the setting."""
    knobs = {}
    for setting in settings:
        path, equals, text = setting.partition("=")
        if not equals or not path.strip():
            raise ValueError(f"--set takes path=value, got {setting!r}")
        knobs[path.strip()] = parse_value(text.strip())
    return knobs


def parse_value(text: str) -> Any:
    """A number, flag, None, a technique with or without knobs, or the text itself."""
    import interreflect

    plain = {"true": True, "false": False, "none": None}
    if text.lower() in plain:
        return plain[text.lower()]
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        name, knobs = _call(text)
    technique = getattr(interreflect, name, None) if name[:1].isupper() else None
    if isinstance(technique, type) and hasattr(technique, "description"):
        return technique(**knobs)
    if knobs or "(" in text:
        raise ValueError(f"there is no technique {name!r}")
    return text


def parse_size(text: str) -> tuple[int, int]:
    """ "640x360" as (640, 360)."""
    sides = text.lower().split("x")
    if len(sides) != 2 or not all(side.isdecimal() for side in sides):
        raise ValueError(f"a size is WIDTHxHEIGHT, such as 640x360, got {text!r}")
    return int(sides[0]), int(sides[1])


def load_study(file: Path) -> Any:
    """The `study` that a Python file defines. ValueError with the file's line where running it fails."""
    from interreflect.study.study import Study

    if not file.is_file():
        raise FileNotFoundError(f"{file}: no such study file")
    try:
        found = runpy.run_path(str(file)).get("study")
    except Exception as error:
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
        line = getattr(error, "lineno", None) or (lines[-1] if lines else "?")
        raise ValueError(f"{file}:{line}: {type(error).__name__}: {error}") from error
    if not isinstance(found, Study):
        raise ValueError(f"{file}: a study file defines `study`, a Study; got {type(found).__name__}")
    return found


def _call(text: str) -> tuple[str, dict[str, Any]]:
    """`Name` or `Name(knob=value)` with literal values; techniques may hold others. ValueError otherwise."""
    try:
        node = ast.parse(text, mode="eval").body
    except SyntaxError:
        return text, {}
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.args:
        return node.func.id, {str(word.arg): parse_value(ast.unparse(word.value)) for word in node.keywords}
    if isinstance(node, ast.Call):
        raise ValueError(f"knobs go by name, as in Name(knob=value), got {text!r}")
    return text, {}


def _kebab(name: str) -> str:
    return "".join(f"-{letter.lower()}" if letter.isupper() and index else letter.lower() for index, letter in enumerate(name))


def _knob_row(knob: dict[str, Any], prefix: str = "") -> Row:
    return "", prefix + knob["name"], knob["type"], knob["unit"], knob_range(knob), repr(knob["default"]), knob["doc"]


def _choices_of(stage: str) -> str:
    from interreflect import _core

    if stage not in _core.stages:
        return ""
    return "one of " + ", ".join(technique.__name__ for technique in _core.stages[stage]["techniques"])


def range_of(limits: Any) -> str:
    """What a method's plain knob may be: choices or an interval."""
    if limits.choices:
        return ", ".join(limits.choices)
    low = "(" if limits.open_minimum else "["
    return f"{low}{limits.minimum:g}, {limits.maximum:g}]".replace("[-inf", "(-inf").replace("inf]", "inf)")


def knob_range(param: Mapping[str, Any]) -> str:
    """What a technique's knob may be: choices, techniques, or an interval."""
    if param.get("choices"):
        return ", ".join(map(str, param["choices"]))
    if param.get("techniques"):
        return ", ".join(getattr(item, "__name__", str(item)) for item in param["techniques"])
    low, high = param.get("minimum"), param.get("maximum")
    if low is None and high is None:
        return ""
    left = "(-inf" if low is None else f"{'(' if param.get('open_minimum') else '['}{low:.10g}"
    right = "inf)" if high is None else f"{high:.10g}{')' if param.get('open_maximum') else ']'}"
    return f"{left}, {right}"


def _nearest(name: str, known: Iterable[str]) -> str:
    near = difflib.get_close_matches(name, list(known), 1, 0.5)
    return f"; did you mean {near[0]!r}?" if near else ""


def _first_line(documented: Any) -> str:
    return (inspect.getdoc(documented) or "").partition("\n")[0]


def _line_about(function: Any, knob: str) -> str:
    """What the docstring's `knob: ...` sentence says."""
    text = inspect.getdoc(function) or ""
    found = [line.strip() for line in text.splitlines() if line.strip().startswith(f"{knob}:")]
    return found[0].removeprefix(f"{knob}:").strip() if found else ""
