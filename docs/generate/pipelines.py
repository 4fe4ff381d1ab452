"""The pipeline figure of a method: its stages in the order in which they ran, each with the technique that does it."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

from docs.generate.settings import Setting
from interreflect import _core
from interreflect.charts.style import new_figure, theme_of
from interreflect.methods.knobs import is_technique

Box = tuple[str, str]  # stage, technique or ""
COLUMNS = 5
SMALL = (48, 36)
COARSE = {"grid.resolution": 16, "place_surfels.surfels": 512, "place_caches.texels": 16}  # stages and their order stay the same
FILL = {"light": ("#e8f1fa", "#f3f3f3", "#fdf1e0"), "dark": ("#1d3550", "#2a2d33", "#4a3413")}  # chosen; fixed; built once


def boxes(setting: Setting, precomputed: Sequence[str]) -> tuple[list[Box], list[Box], list[Box]]:
    """What is built once; the stages of a frame as its profile lists them; techniques that no stage of their own runs."""
    knobs = setting.method.knobs()
    method = setting.method.replace({path: value for path, value in COARSE.items() if path in knobs})
    frame = method.prepare(setting.scene).render(setting.camera, size=SMALL)
    chosen = {name: type(value).__name__ for name, value in method.exact_knobs().items() if is_technique(value) and name in _core.stages}
    once = [(name, chosen[name]) for name in precomputed]
    ran = [(name, chosen.get(name, "")) for name in frame.profile.stages]
    named = {name for name, _ in (*once, *ran)}
    return once, ran, [(name, technique) for name, technique in chosen.items() if name not in named]


def figure_of(setting: Setting, precomputed: Sequence[str], dark: bool) -> Figure:
    once, ran, within = boxes(setting, precomputed)
    fill = FILL["dark" if dark else "light"]
    entries = [(box, fill[2]) for box in once] + [(box, fill[0] if box[1] else fill[1]) for box in ran]
    rows = -(-len(entries) // COLUMNS)
    figure = new_figure((7.6, 0.95 * rows + 0.35), dark)
    ax = figure.subplots()
    ax.set(xlim=(0, COLUMNS), ylim=(-rows - 0.45, 0))
    ax.axis("off")
    for index, (box, colour) in enumerate(entries):
        _box(ax, index % COLUMNS, -(index // COLUMNS), box, colour, dark)
        if index + 1 < len(entries):
            _arrow(ax, index, dark)
    words = "within these: " + ", ".join(f"{name} by {technique}" for name, technique in within) if within else ""
    if once:
        words = f"orange: built once{'; ' if words else ''}{words}"
    ax.text(0.05, -rows - 0.22, words, fontsize=7.5, color=theme_of(dark)["ink"], va="center")
    return figure


def _box(ax: Any, x: int, y: int, box: Box, colour: str, dark: bool) -> None:
    ink = theme_of(dark)["ink"]
    ax.add_patch(FancyBboxPatch((x + 0.07, y - 0.85), 0.78, 0.6, boxstyle="round,pad=0.02", facecolor=colour, edgecolor=ink, linewidth=0.7))
    name, technique = box
    lines = textwrap.fill(name.replace("_", " "), 16)
    ax.text(x + 0.46, y - (0.44 if technique else 0.55), lines, ha="center", va="center", fontsize=7.5, color=ink)
    if technique:
        size = 6.6 if len(technique) < 18 else 5.6
        ax.text(x + 0.46, y - 0.7, technique, ha="center", va="center", fontsize=size, color=ink, weight="bold")


def _arrow(ax: Any, index: int, dark: bool) -> None:
    x, y = index % COLUMNS, -(index // COLUMNS)
    style = {"arrowstyle": "->", "color": theme_of(dark)["faint"], "linewidth": 1.0}
    if x + 1 < COLUMNS:
        ax.annotate("", (x + 1.05, y - 0.55), (x + 0.88, y - 0.55), arrowprops=style)
    else:  # on to the next row
        turn = y - 1.0
        ax.plot([x + 0.46, x + 0.46, 0.46, 0.46], [y - 0.88, turn, turn, y - 1.1], color=style["color"], linewidth=1.0)
        ax.annotate("", (0.46, y - 1.24), (0.46, y - 1.1), arrowprops=style)


def write(setting: Setting, precomputed: Sequence[str], stem: Path) -> None:
    stem.parent.mkdir(parents=True, exist_ok=True)
    for theme in ("light", "dark"):
        figure_of(setting, precomputed, theme == "dark").savefig(stem.with_name(f"{stem.name}-{theme}.svg"), metadata={"Date": None})
