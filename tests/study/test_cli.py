"""The command line: what it finds, what it writes, and one line with exit code 2 for a user's error."""

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest

from interreflect.catalogue import method_rows, parse_knobs, parse_size, parse_value, scene_rows, technique_rows

PACKAGE = Path(__file__).parents[2] / "python"
RUN = "import sys; sys.argv[0] = 'interreflect'; from interreflect.cli import main; main()"


def interreflect(*arguments, code=RUN):
    environment = os.environ | {"PYTHONPATH": str(PACKAGE), "COLUMNS": "200"}
    return subprocess.run([sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True, env=environment, timeout=60)


def test_help_names_every_command():
    done = interreflect("--help")
    assert done.returncode == 0
    for command in ("scenes", "methods", "techniques", "render", "study", "report", "cache"):
        assert f" {command} " in done.stdout


def test_help_loads_no_heavy_library():
    heavy = ("numpy", "pandas", "matplotlib", "scipy", "skimage", "trimesh", "OpenImageIO", "tqdm", "interreflect._core")
    code = f"import sys, interreflect, interreflect.cli; print([name for name in {heavy!r} if name in sys.modules])"
    assert interreflect(code=code).stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["render", "cornel_box"], "did you mean 'cornell_box'?"),
        (["render", "absent.toml"], "absent.toml"),
        (["render", "cornell_box", "--method", "voxel-cone-tracin"], "did you mean 'voxel-cone-tracing'?"),
        (["render", "cornell_box", "--preset", "Freed 2014"], "did you mean 'Freed 2018'?"),
        (["study", "absent.py", "--out", "x"], "absent.py: no such study file"),
        (["report", "absent"], "absent: no study"),
    ],
)
def test_a_users_error_is_one_line_and_exit_code_2(arguments, words, tmp_path):
    done = interreflect(*arguments)
    assert done.returncode == 2, done.stderr
    assert done.stderr.startswith("interreflect: ")
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("study = 3", "a study file defines `study`, a Study; got int"),
        ("x = 1\n1 / 0", ":2: ZeroDivisionError"),
        ("def (", ":1: SyntaxError"),
    ],
)
def test_a_study_file_that_fails_names_its_line(tmp_path, text, words):
    (tmp_path / "bad.py").write_text(text)
    done = interreflect("study", tmp_path / "bad.py", "--out", tmp_path / "r")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert words in done.stderr


def test_a_study_file_is_measured_and_reported(tmp_path):
    (tmp_path / "study.py").write_text(
        textwrap.dedent(f"""
        import pathlib, sys
        sys.path.insert(0, {str(Path(__file__).parent)!r})
        import interreflect as ir
        from study_fakes import Fake, Scene, use_fake_truth
        use_fake_truth(pathlib.Path({str(tmp_path)!r}) / "truths")
        study = ir.Study(name="fakes", scenes=[Scene()], methods=ir.sweep(Fake, {{"mode": ["ok", "raises"]}}), size=(24, 16), repeats=1)
    """)
    )
    done = interreflect("study", tmp_path / "study.py", "--out", tmp_path / "r")
    assert done.returncode == 0, done.stderr
    assert "2 cells" in done.stdout
    assert "1 failed" in done.stdout
    assert "lamp broken" in done.stderr
    done = interreflect("report", tmp_path / "r", "-o", tmp_path / "page.html")
    assert done.returncode == 0, done.stderr
    assert "<title>fakes</title>" in (tmp_path / "page.html").read_text()


def test_the_cache_is_listed_and_cleared(tmp_path, monkeypatch):
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path))
    (tmp_path / "references").mkdir()
    (tmp_path / "references" / "old.npz").write_bytes(bytes(2**20))
    listed = interreflect("cache", "list")
    assert "old.npz" in listed.stdout
    assert "1 files, 1.0 of at most" in listed.stdout
    assert "removed 1 files" in interreflect("cache", "clear").stdout
    assert not list(tmp_path.glob("*/*"))


def test_every_built_in_scene_is_listed_with_its_knobs():
    rows = scene_rows()
    assert ("", "light", "choice", "", "area, point, spot", "'area'") in [row[:6] for row in rows]
    done = interreflect("scenes")
    assert done.returncode == 0, done.stderr
    assert "cornell_box" in done.stdout


@pytest.mark.parametrize(
    ("text", "value"), [("64", 64), ("1e-3", 1e-3), ("true", True), ("False", False), ("none", None), ("ggx", "ggx"), ("(1, 2)", (1, 2))]
)
def test_values_are_read_as_what_they_look_like(text, value):
    assert parse_value(text) == value


def test_settings_are_path_and_value():
    assert parse_knobs(["grid.resolution=64", "march.name=a=b"]) == {"grid.resolution": 64, "march.name": "a=b"}
    with pytest.raises(ValueError, match="path=value, got 'grid'"):
        parse_knobs(["grid"])


def test_nothing_in_a_value_is_run():
    with pytest.raises(ValueError, match="Evil"):
        parse_value("Evil(x=1)")
    with pytest.raises(ValueError, match="knobs go by name"):
        parse_value("__import__('os').system('true')")


def test_every_knob_of_every_method_is_listed():
    rows = [row[:6] for row in method_rows()]
    assert ("", "spp", "int", "", "[1, inf)", "16") in rows
    assert ("", "milliseconds", "float | None", "ms", "(0, inf)", "None") in rows
    assert any(row[1] == "grid.resolution" and row[3] == "voxels" and row[5] == "128" for row in rows)


def test_every_technique_is_listed_with_unit_range_and_default():
    rows = technique_rows("shadow")
    assert any(row[1] == "bias" and row[3] == "texels" for row in rows)
    assert all(row[6] for row in rows)
    with pytest.raises(ValueError, match="there is no stage 'shadows'"):
        technique_rows("shadows")


@pytest.mark.parametrize("text", ["640", "640x", "axb", "-1x3", "1x2x3"])
def test_a_size_is_width_x_height(text):
    assert parse_size("640x360") == (640, 360)
    with pytest.raises(ValueError, match="WIDTHxHEIGHT"):
        parse_size(text)


def test_no_module_stands_where_a_function_should():
    code = textwrap.dedent("""
        import importlib, pkgutil, interreflect as ir
        for module in [*pkgutil.iter_modules(ir.__path__), *pkgutil.iter_modules([ir.__path__[0] + "/study"], "study.")]:
            importlib.import_module("interreflect." + module.name)
        print([callable(getattr(ir, name)) for name in ("about", "run", "reference", "report", "pareto", "sweep", "load_records")])
    """)
    done = interreflect(code=code)
    assert done.stdout.strip() == str([True] * 7), done.stderr
