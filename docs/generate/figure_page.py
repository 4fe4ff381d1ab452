"""The page of what is reproduced and what is asked: every experiment by its first sentence, with the command that draws it."""

from __future__ import annotations

import ast

from experiments.figures import HERE, PAPERS, figures_of, questions

from docs.generate.technique_pages import cell

HEAD = """# Figures and questions

`./run figures NAME` measures what is missing of an experiment's records and draws it into results/figures; a paper's name stands for all
of its files. `./run figures gallery` makes one page of all that is recorded, with what the papers print beside ours; `./run figures ledger`
says of every claim whether it holds. Most need the papers' scenes, or stand-ins (`INTERREFLECT_SCENES`), and some take hours.
"""


def figure_page() -> str:
    parts = [HEAD, "## Questions", table(questions())]
    for paper in PAPERS:
        parts += [f"## {paper.title()}", table(figures_of(paper))]
    return "\n\n".join(parts) + "\n"


def table(names: list[str]) -> str:
    rows = [f"| {cell(first_sentence(name))} | `./run figures {name}` |" for name in names]
    return "\n".join(["| What | Command |", "|---|---|", *rows])


def first_sentence(name: str) -> str:
    told = ast.get_docstring(ast.parse((HERE / f"{name.replace('-', '_')}.py").read_text())) or ""
    return " ".join(told.partition("\n\n")[0].split())
