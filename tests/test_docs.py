"""The docs: what is written by hand is there and says what it must, every block of code runs, and every picture names its command."""

import re
import sys
from pathlib import Path

import pytest

pytest.importorskip("sphinx", reason="needs the extra `docs`")

from docs.generate import measured
from docs.generate.failure_page import failure_page
from docs.generate.figure_page import figure_page
from docs.generate.method_pages import method_page
from docs.generate.notes import FOLDER, KEYS, notes_of
from docs.generate.settings import main_knob, method_names, techniques
from docs.generate.technique_pages import stage_page, technique_page

from interreflect import _core

ROOT = Path(__file__).parents[1]
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


def test_every_technique_has_five_sentences():
    """What goes in, what it does, what it approximates, what it costs, when to choose it: one a line of its notes."""
    lacking = {name: len(notes_of("techniques", name).sentences) for name in techniques()}
    assert {name: count for name, count in lacking.items() if count != 5} == {}
    for name in techniques():
        assert all(line[0].isupper() and line.endswith(".") for line in notes_of("techniques", name).sentences), name


def test_every_technique_was_measured_or_says_why_not():
    lacking = [name for name, cls in techniques().items() if main_knob(cls) and measured.curve_of(name) is None]
    assert lacking == [], "measure them: .venv/bin/python -m docs.measure " + " ".join(lacking)
    for name, cls in techniques().items():
        if main_knob(cls) is None:
            assert "unmeasured" in notes_of("techniques", name).head or not cls.description["params"], name


def test_the_architecture_names_every_room_and_folder_as_they_are():
    sys.path.insert(0, str(ROOT / "tests"))
    from test_house import ABOVE

    text = (ROOT / "docs" / "architecture.md").read_text()
    rooms = dict(re.findall(r"^\| `(\w+)` \| .* \| (.*) \|$", text, re.MULTILINE))
    told = {room: set(re.findall(r"`(\w+)`", above)) for room, above in rooms.items() if room in ABOVE}
    assert told == ABOVE and set(ABOVE) == {path.name for path in (ROOT / "cpp" / "interreflect").iterdir() if path.is_dir()}
    core = text.partition("## The package")[0]
    assert set(re.findall(r"stages? ((?:`\w+`(?:, | and )?)+)", core)) and all(f"`{stage}`" in core for stage in _core.stages)
    package = {path.parent.name for path in (ROOT / "python" / "interreflect").glob("*/__init__.py")}
    folders = set(re.findall(r"^\| `(\w+)` \| [^|]* \|$", text.partition("## The package")[2], re.MULTILINE))
    assert folders == package
    outside = {"experiments", "bench", "notebooks", "tools", "docs", "tests"}
    assert all((ROOT / name).is_dir() and f"`{name}`" in text for name in outside)


def test_the_page_of_figures_names_every_experiment_and_says_what_it_is():
    from experiments.figures import HERE

    rows = {command: told for told, command in re.findall(r"^\| (.+) \| `\./run figures (\S+)` \|$", figure_page(), re.MULTILINE)}
    drawn = {path.stem for path in HERE.glob("*.py") if "\ndef chart(" in path.read_text()}
    assert drawn <= set(rows) and len(rows) > 60 and all(len(told) > 20 for told in rows.values())
