"""`./run figures [name ...]`: runs what is missing of an experiment's records and draws its chart from them.

A name is a question (a file of this folder with one `study` and one `chart(records)`, or a `measure(folder)` whose findings its chart
draws), a paper (`freed`, `jendersie`, `rehfeld`, `weinzierl-heigl`: a folder, all of its
files), one file of it (`freed/table_5_1`: `studies()` and `chart(*records)`), or `ledger`. Without a name: every question.
Pictures go to results/figures. What needs a scene that is not here is left out and said so.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import interreflect as ir
from experiments.shared.keep import FOLDER, records_of

HERE = Path(__file__).parent
PAPERS = ("freed", "jendersie", "rehfeld", "weinzierl-heigl")
LEDGER = "ledger"


def questions() -> list[str]:
    return sorted(path.stem for path in HERE.glob("*.py") if path.stem not in ("figures", "__init__"))


def module_of(name: str) -> Any:
    """`freed/figure_1_1` is experiments.freed.figure_1_1; folders have underscores where names have hyphens."""
    return import_module(f"experiments.{name.replace('/', '.').replace('-', '_')}")


def figures_of(paper: str) -> list[str]:
    """`freed/figure_1_1`, ...: the files of a paper's folder that draw something."""
    return [f"{paper}/{path.stem}" for path in sorted((HERE / paper.replace("-", "_")).glob("*.py")) if "\ndef chart(" in path.read_text()]


def names() -> list[str]:
    return [*questions(), *PAPERS, *(name for paper in PAPERS for name in figures_of(paper)), LEDGER]


def findings(experiment: Any, folder: Path) -> Any:
    """Of a question: the records of its study, or what it measures by itself; what `folder` holds already is not measured again."""
    return ir.run(experiment.study, folder) if hasattr(experiment, "study") else experiment.measure(folder)


def draw(name: str, folder: Path) -> list[Path]:
    """The pictures of one question or one file of a paper, drawn from records."""
    experiment = module_of(name)
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    if "/" not in name:
        chart = experiment.chart(findings(experiment, folder / name))
        endings = [".pdf"]
    else:
        chart = experiment.chart(*(records_of(study, folder) for study in experiment.studies()))
        endings = [".pdf", ".png"]
    made = [folder / f"{name}{ending}" for ending in endings]
    for path in made:
        chart.savefig(path)
    return made


def make(name: str, folder: Path) -> None:
    """Everything of this name; a scene that is not here is said, not fatal."""
    if name == LEDGER:
        from experiments.ledger.book import write

        print(f"{name}: {write(folder)}")
        return
    for one in figures_of(name) if name in PAPERS else [name]:
        try:
            print(f"{one}: {' '.join(map(str, draw(one, folder)))}", flush=True)
        except FileNotFoundError as error:
            print(f"{one}: left out, the scene is not here: {error}", flush=True)


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="./run figures", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiment", nargs="*", help=f"one of {', '.join(names())}; every question where none is named")
    given = parser.parse_args(arguments)
    for name in given.experiment:
        if name not in names():
            parser.error(f"there is no experiment {name!r}; there are {', '.join(names())}")
    for name in given.experiment or questions():
        make(name, FOLDER)


if __name__ == "__main__":
    main()
