"""Every figure and table of the four papers on one page: picture, what it shows, what the paper printed, and the command that makes it."""

from __future__ import annotations

import os
from collections.abc import Callable
from html import escape
from importlib import import_module
from pathlib import Path
from typing import Any

from experiments.ledger.page import PAPERS

TITLES = {"freed": PAPERS["F"], "jendersie": PAPERS["J"], "rehfeld": PAPERS["R"], "weinzierl-heigl": PAPERS["W"]}
STYLE = (
    "body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 70em; padding: 0 1em; color: #222 } "
    "figure { margin: 2em 0; border-top: 1px solid #ccc; padding-top: 1em } img { max-width: 100%; max-height: 60em } "
    "figcaption { margin: .4em 0 } code { background: #f2f2f2; padding: .1em .3em } "
    ".missing { color: #8a4500 } nav a { margin-right: 1.2em }"
)
NUMBERS = "The paper prints no numbers here."


def write(folder: Path, figures: dict[str, list[str]], missing: Callable[[str], str]) -> Path:
    """Writes gallery.html in `folder`, where pictures lie. figures: per paper the names of its files, as in `./run figures NAME`.
    missing: why a figure has no picture."""
    parts = [
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Figures of the papers</title><style>{STYLE}</style>',
        "<h1>Figures and tables of the papers, made anew</h1>",
        "<p>All from records of our own runs; times are those of this machine. What each claim comes to stands in the "
        '<a href="ledger.html">ledger</a>.</p>',
        "<nav>" + "".join(f'<a href="#{paper}">{escape(TITLES[paper])}</a>' for paper in figures) + "</nav>",
    ]
    for paper, names in figures.items():
        parts.append(f'<h2 id="{paper}">{escape(TITLES[paper])}</h2>')
        parts += [_figure(folder, name, missing) for name in sorted(names, key=_order)]
    page = folder / "gallery.html"
    folder.mkdir(parents=True, exist_ok=True)
    page.write_text("\n".join(parts) + "\n")
    return page


def _order(name: str) -> tuple[Any, ...]:
    """Figures first, then tables, each by number; then what has none."""
    kind, *numbers = name.split("/")[1].split("_")
    numbered = kind in ("figure", "table") and all(number.isdigit() for number in numbers)
    return (("figure", "table").index(kind), *map(int, numbers)) if numbered else (2, 0, name)


def _figure(folder: Path, name: str, missing: Callable[[str], str]) -> str:
    module = import_module(f"experiments.{name.replace('/', '.').replace('-', '_')}")
    caption = " ".join((module.__doc__ or "").split())
    picture = folder / f"{name}.png"
    shown = (
        f'<img src="{os.path.relpath(picture, folder)}" alt="{escape(caption)}" loading="lazy">'
        if picture.exists()
        else f'<p class="missing">No picture: {escape(missing(name))}</p>'
    )
    printed = f"The paper prints: {module.PAPER_PRINTS}." if hasattr(module, "PAPER_PRINTS") else NUMBERS
    return (
        f'<figure id="{name}"><figcaption><b>{escape(caption)}</b></figcaption>{shown}'
        f"<figcaption>{escape(printed)}<br><code>./run figures {name}</code></figcaption></figure>"
    )
