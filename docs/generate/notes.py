"""What no description holds: five sentences, an equation with its errata, which knob matters most. One file a technique, stage or method.

    ---
    main_knob: spacing            # what the charts sweep, and at which values; or `unmeasured: why there is no chart`
    values: [1, 0.5, 0.25]
    ---
    One sentence a line.

    ## Equation                   # with what the paper prints wrongly
"""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import yaml

FOLDER = Path(__file__).parents[1] / "notes"
KEYS = {
    "techniques": {"main_knob", "values", "unmeasured", "scene", "camera", "method", "stage", "knobs", "frames", "part", "paper"},
    "stages": {"scene", "camera", "method", "knobs", "frames", "part", "bypass"},
    "methods": {"scene", "camera", "knobs", "frames", "precomputed"},
}


@dataclasses.dataclass(frozen=True)
class Notes:
    """head: settings by name. sentences: one a line. rest: the equation, Markdown."""

    head: dict[str, Any]
    sentences: tuple[str, ...]
    rest: str


NONE = Notes({}, (), "")


def notes_of(kind: str, name: str) -> Notes:
    """Empty where there are none. ValueError names the file and a key that means nothing."""
    path = FOLDER / kind / f"{name}.md"
    if not path.exists():
        return NONE
    _, head, body = path.read_text().split("---\n", 2)
    settings = yaml.safe_load(head) or {}
    if wrong := set(settings) - KEYS[kind]:
        raise ValueError(f"{path}: no such setting: {', '.join(sorted(wrong))}; there are {', '.join(sorted(KEYS[kind]))}")
    text, _, rest = body.strip().partition("\n## Equation\n")
    return Notes(settings, tuple(line for line in text.splitlines() if line), rest.strip())
