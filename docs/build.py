"""`./run docs`: assembles pages, pictures and charts in results/docs/source and builds results/docs/html from them.

Warnings are errors, links that lead nowhere among them. What did not change is not made again: pictures lie in the user's cache.
"""

from __future__ import annotations

import argparse
import inspect
import multiprocessing
import os
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import interreflect as ir
from docs.generate import charts, measured, method_pages, pictures, pipelines
from docs.generate.failure_page import failure_page
from docs.generate.figure_page import figure_page
from docs.generate.notes import notes_of
from docs.generate.settings import method_names, setting_of, techniques
from docs.generate.technique_pages import stage_page, technique_page
from interreflect import _core
from interreflect.progress import bar

HERE = Path(__file__).parent
ROOT = HERE.parent
OUT = ROOT / "results" / "docs"


class Source:
    """A folder of which every file is written anew only where it differs; files that no build asked for are removed in the end."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.kept = folder, set[Path]()

    def put(self, name: str, content: str | bytes) -> None:
        path, given = self.folder / name, content.encode() if isinstance(content, str) else content
        self.kept.add(path)
        if not path.exists() or path.read_bytes() != given:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(given)

    def keep_themes(self, stem: str, made_of: list[Path]) -> bool:
        """Whether the figure for light pages and that for dark ones are there, and newer than all that they are made of."""
        paths = [self.folder / f"{stem}-{theme}.svg" for theme in ("light", "dark")]
        self.kept.update(paths)
        newest = max(path.stat().st_mtime for path in made_of)
        return all(path.exists() and path.stat().st_mtime > newest for path in paths)

    def remove_others(self) -> None:
        for path in self.folder.rglob("*"):
            if path.is_file() and path not in self.kept and path.relative_to(self.folder).parts[0] != "gallery":
                path.unlink()


def assemble(source: Source, names: dict[str, Any]) -> None:
    """Every page and picture. names: the techniques."""
    for path in (HERE / "conf.py", *HERE.glob("*.md"), *HERE.glob("*.png"), *HERE.glob("examples/*.*"), *HERE.glob("_static/*.*")):
        source.put(str(path.relative_to(HERE)), path.read_bytes())
    for path in (ROOT / "notebooks").glob("*.ipynb"):
        source.put(f"notebooks/{path.name}", path.read_bytes())
    for stage in _core.stages:
        source.put(f"stages/{stage}.md", stage_page(stage))
    for name, technique in names.items():
        source.put(f"techniques/{name}.md", technique_page(technique))
    for name in method_names():
        source.put(f"methods/{name}.md", method_pages.method_page(name))
    source.put("failures.md", failure_page())
    source.put("figures.md", figure_page())
    source.put("stages.md", listing("Stages and techniques", "stages", list(_core.stages)))
    source.put("methods.md", listing("Methods", "methods", method_names()))
    draw(source, names)


def listing(title: str, folder: str, names: list[str]) -> str:
    intro = (HERE / "notes" / f"{folder}.md").read_text()
    entries = "\n".join(f"{folder}/{name}" for name in names)
    return f"# {title}\n\n{intro}\n```{{toctree}}\n:maxdepth: {2 if folder == 'stages' else 1}\n\n{entries}\n```\n"


def draw(source: Source, names: dict[str, Any]) -> None:
    drawn_by = [Path(charts.__file__), Path(measured.__file__)]
    curves = {source.folder / "charts" / name: curve for name in names if (curve := measured.curve_of(name)) is not None}
    wanted = {
        stem: curve
        for stem, curve in curves.items()
        if not source.keep_themes(f"charts/{stem.name}", [measured.FOLDER / f"{stem.name}.csv", *drawn_by])
    }
    with ProcessPoolExecutor(2, multiprocessing.get_context("spawn")) as pool:
        waiting = [pool.submit(charts.write, curve, stem) for stem, curve in wanted.items()]
        draw_methods_and_pictures(source, names)
        for one in waiting:
            one.result()


def draw_methods_and_pictures(source: Source, names: dict[str, Any]) -> None:
    shown = {name: method_pages.setting_of(name) for name in method_names()}
    for name, setting in shown.items():
        if not source.keep_themes(f"pipelines/{name}", [Path(pipelines.__file__), Path(inspect.getfile(type(setting.method)))]):
            pipelines.write(setting, notes_of("methods", name).head.get("precomputed", []), source.folder / "pipelines" / name)
    wanted = {name: setting_of(technique) for name, technique in names.items()} | shown
    with bar(list(wanted.items()), desc="pictures", unit="picture") as progress:
        for name, setting in progress:
            source.put(f"pictures/{name}.png", pictures.picture(setting))


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=OUT)
    out = parser.parse_args(arguments).out
    source = Source(out / "source")
    assemble(source, techniques())
    source.remove_others()
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-n", "-q", "-j", "auto"]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT / "python"), str(ROOT)]), "MPLBACKEND": "agg"}
    done = subprocess.run([*command, "-d", str(out / "doctrees"), str(out / "source"), str(out / "html")], env=environment, check=False)
    if done.returncode == 0:
        print(f"{out / 'html' / 'index.html'}: interreflect {ir.__version__}")
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
