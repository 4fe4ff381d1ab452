"""The docs: what is written by hand is there and says what it must, every block of code runs, and every picture names its command."""

import re
from pathlib import Path

import pytest

pytest.importorskip("sphinx", reason="needs the extra `docs`")

from docs.generate.failure_page import failure_page
from docs.generate.method_pages import method_page
from docs.generate.notes import FOLDER, KEYS, notes_of
from docs.generate.settings import method_names, techniques
from docs.generate.technique_pages import stage_page, technique_page

from interreflect import _core

DOCS = Path(__file__).parents[1] / "docs"
GENERATED = {
    **{name: lambda name=name: technique_page(techniques()[name]) for name in techniques()},
    **{stage: lambda stage=stage: stage_page(stage) for stage in _core.stages},
    **{name: lambda name=name: method_page(name) for name in method_names()},
    "failures": failure_page,
}


def blocks(text, language):
    return re.findall(rf"```({language})\n(.*?)```", text, re.DOTALL)


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_page_has_knobs_code_that_runs_and_pictures_that_name_their_command(name):
    text = GENERATED[name]()
    (code,) = [body for _, body in blocks(text, "python")]
    exec(code, {})
    for figure in re.findall(r":::\{figure\}.*?\n:::", text, re.DOTALL):
        assert "`./run docs`" in figure, figure


def test_every_note_is_of_something_that_exists():
    known = {"techniques": set(techniques()), "stages": set(_core.stages), "methods": set(method_names())}
    for kind in KEYS:
        assert {path.stem for path in (FOLDER / kind).glob("*.md")} <= known[kind]
    assert all(notes_of("stages", stage).sentences for stage in _core.stages), "a stage's question"
    assert all(notes_of("methods", name).sentences for name in method_names())
