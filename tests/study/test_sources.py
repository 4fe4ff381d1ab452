"""Digests of code: another for repaired code, the same for the same."""

import subprocess
from pathlib import Path

import interreflect.study.sources as sources
from interreflect.study.sources import source_digest

ROOT = Path(__file__).parents[2]


class Plain:
    """Defined by this file, as a user's own method would be."""


def test_a_change_of_a_file_that_matters_changes_the_digest(tmp_path, monkeypatch):
    (tmp_path / "shade.py").write_text("albedo = 1")
    monkeypatch.setattr(sources, "_package_files", lambda: {tmp_path / "shade.py"})
    before = source_digest.__wrapped__(Plain)
    assert source_digest.__wrapped__(Plain) == before
    (tmp_path / "shade.py").write_text("albedo = 2")
    assert source_digest.__wrapped__(Plain) != before


def test_the_file_that_defines_a_method_matters():
    assert Path(__file__).resolve() in sources._defining_files(Plain)


def test_what_only_draws_or_reads_does_not_matter():
    names = {path.relative_to(sources.PACKAGE).as_posix() for path in sources._package_files()}
    assert {"methods/method.py", "methods/path_tracing.py", "stages/view.py", "scenes/compile.py"} <= names
    assert not names & {"charts/records.py", "cli.py", "study/report.py", "scenes/builtin/cornell_box.py"}


def test_the_core_knows_the_sources_it_was_built_from(tmp_path):
    """The build's own script over a copy of the sources: another digest as soon as one of them changes."""

    def digest():
        script = ROOT / "cmake" / "sources_digest.cmake"
        command = ["cmake", f"-DROOT={tmp_path}", f"-DOUTPUT={tmp_path / 'digest.h'}", "-DFLAGS=-O3", "-P", str(script)]
        subprocess.run(command, check=True)
        return (tmp_path / "digest.h").read_text()

    (tmp_path / "cpp").mkdir()
    (tmp_path / "cpp" / "a.cpp").write_text("int a;")
    before = digest()
    assert digest() == before
    (tmp_path / "cpp" / "a.cpp").write_text("int b;")
    changed = digest()
    assert changed != before
    (tmp_path / "cpp" / "a.cpp").rename(tmp_path / "cpp" / "c.cpp")
    assert digest() not in (before, changed)
