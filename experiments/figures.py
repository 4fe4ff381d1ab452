"""`./run figures [--recorded] [name ...]`: runs what is missing of an experiment's records and draws its chart from them.

A name is a question (a file of this folder with one `study` and one `chart(records)`, or a `measure(folder)` whose findings its chart
draws), a paper (`freed`, `jendersie`, `rehfeld`, `weinzierl-heigl`: a folder, all of its files), one file of it (`freed/table_5_1`:
`studies()` and `chart(*records)`), `ledger` (or one claim: `ledger/F1`), `findings` (what questions answer that no paper does, on one
page), or `gallery`: the page of every figure that was drawn, which is written after a paper as well. Without a name: every question.
Pictures go to results/figures. What needs a scene that is not here is left out and said so. --recorded: nothing is measured; what papers
and ledger lack of records is named.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

import interreflect as ir
from experiments.shared.keep import FOLDER, NotRecorded, recorded, records_of

HERE = Path(__file__).parent
PAPERS = ("freed", "jendersie", "rehfeld", "weinzierl-heigl")
LEDGER, GALLERY, FINDINGS = "ledger", "gallery", "findings"
WITHOUT_A_QUESTION = ("__init__", "figures", "gallery")


def questions() -> list[str]:
    return sorted(path.stem for path in HERE.glob("*.py") if path.stem not in WITHOUT_A_QUESTION)


def module_of(name: str) -> Any:
    """`freed/figure_1_1` is experiments.freed.figure_1_1; folders have underscores where names have hyphens."""
    return import_module(f"experiments.{name.replace('/', '.').replace('-', '_')}")


def figures_of(paper: str) -> list[str]:
    """`freed/figure_1_1`, ...: the files of a paper's folder that draw something."""
    return [f"{paper}/{path.stem}" for path in sorted((HERE / paper.replace("-", "_")).glob("*.py")) if "\ndef chart(" in path.read_text()]


def names() -> list[str]:
    return [*questions(), *PAPERS, *(name for paper in PAPERS for name in figures_of(paper)), LEDGER, GALLERY, FINDINGS]


def is_claim(name: str) -> bool:
    """Whether this is `ledger/F1`, a claim's name after the ledger's."""
    from experiments.ledger.book import CLAIMS

    return name in {f"{LEDGER}/{claim.name}" for claim in CLAIMS}


def findings(experiment: Any, folder: Path) -> Any:
    """Of a question: the records of its study, or what it measures by itself; what `folder` holds already is not measured again."""
    return ir.run(experiment.study, folder) if hasattr(experiment, "study") else experiment.measure(folder)


def draw(name: str, folder: Path, measuring: bool = True) -> list[Path]:
    """The pictures of one question or one file of a paper, drawn from records. measuring: of a paper's file, measure what is missing;
    else NotRecorded."""
    experiment = module_of(name)
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
    if "/" not in name:
        chart = experiment.chart(findings(experiment, folder / name))
        endings = [".pdf"]
    else:
        chart = experiment.chart(*((records_of if measuring else recorded)(study, folder) for study in experiment.studies()))
        endings = [".pdf", ".png"]
    made = [folder / f"{name}{ending}" for ending in endings]
    for path in made:
        chart.savefig(path)
    return made


def make(name: str, folder: Path, measuring: bool = True) -> None:
    """Everything of this name; a scene or a record that is not here is said, not fatal."""
    if name.split("/")[0] == LEDGER:
        from experiments.ledger.book import write

        page = write(folder, name.split("/")[1:], measuring)
        if name == LEDGER:
            print(f"{name}: {page}")
        return
    if name == FINDINGS:
        from experiments.shared.findings import write as write_findings

        print(f"{name}: {write_findings(folder)}")
        return
    for one in figures_of(name) if name in PAPERS else [] if name == GALLERY else [name]:
        try:
            print(f"{one}: {' '.join(map(str, draw(one, folder, measuring)))}", flush=True)
        except FileNotFoundError as error:
            print(f"{one}: left out, the scene is not here: {error}", flush=True)
        except NotRecorded as lacking:
            print(f"{one}: left out, {lacking}", flush=True)
    if name in (*PAPERS, GALLERY):
        from experiments.gallery import write as write_gallery

        print(f"{GALLERY}: {write_gallery(folder, {paper: figures_of(paper) for paper in PAPERS}, lambda one: why_missing(one, folder))}")


def why_missing(name: str, folder: Path) -> str:
    """Why a file of a paper has no picture."""
    try:
        for study in module_of(name).studies():
            recorded(study, folder)
    except FileNotFoundError as error:
        return f"the scene is not here: {error}"
    except NotRecorded as lacking:
        return str(lacking)
    return "recorded, not drawn yet"


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(prog="./run figures", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("experiment", nargs="*", help=f"one of {', '.join(names())}; every question where none is named")
    parser.add_argument("--recorded", action="store_true", help="measure nothing: papers, ledger and gallery from what is recorded")
    given = parser.parse_args(arguments)
    if given.recorded and not given.experiment:
        parser.error("--recorded: name papers, files of them, the ledger or the gallery; questions measure by themselves")
    for name in given.experiment:
        if given.recorded and name in (*questions(), FINDINGS):
            parser.error(f"--recorded: {name} is a question, which measures by itself")
        if name not in names() and not is_claim(name):
            parser.error(f"there is no experiment {name!r}; there are {', '.join(names())}")
    for name in given.experiment or questions():
        make(name, FOLDER, measuring=not given.recorded)


if __name__ == "__main__":
    main()
