"""`./run figures [experiment ...]`: runs each experiment of this folder (those named, or all) and draws its chart from the records.

An experiment is a file with one question as its docstring, one `study`, and one function `chart(records)`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path

import interreflect as ir

HERE = Path(__file__).parent


def names() -> list[str]:
    return sorted(path.stem for path in HERE.glob("*.py") if path.stem not in ("figures", "__init__"))


def draw(name: str, folder: Path) -> Path:
    experiment = import_module(f"experiments.{name}")
    records = ir.run(experiment.study, folder / name)
    picture = folder / f"{name}.pdf"
    experiment.chart(records).savefig(picture)
    return picture


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="./run figures", description=__doc__)
    parser.add_argument("experiment", nargs="*", help=f"one of {', '.join(names())}; all where none is named")
    given = parser.parse_args(arguments)
    for name in given.experiment:
        if name not in names():
            parser.error(f"there is no experiment {name!r}; there are {', '.join(names())}")
    for name in given.experiment or names():
        print(f"{name}: {draw(name, Path('results') / 'figures')}")


if __name__ == "__main__":
    main()
