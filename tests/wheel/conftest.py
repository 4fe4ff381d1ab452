"""The wheel, its sources' archive and a bare environment that holds the wheel: made once for the tests below."""

import os
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def maker():
    """tools/wheel.py, what `./run wheel` calls."""
    for tool in ("build", "auditwheel"):
        pytest.importorskip(tool, reason="needs the extra `dev`")
    sys.path.insert(0, str(ROOT / "tools"))
    import wheel

    return wheel


@pytest.fixture(scope="session")
def wheel_path(maker, tmp_path_factory):
    return maker.build_wheel(tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="session")
def bare_python(wheel_path):
    """A Python that has nothing but the wheel and what its metadata ask for."""
    with tempfile.TemporaryDirectory(prefix="bare") as folder:
        venv.create(folder, with_pip=True)
        python = Path(folder) / "bin" / "python"
        probe = _pip(python, "download", "--no-deps", "--dest", f"{folder}/probe", "typer>=0.12")
        if probe.returncode != 0:
            pytest.skip("no package index can be reached, and a bare environment needs numpy and others from one")
        installed = _pip(python, "install", "--no-compile", str(wheel_path))
        assert installed.returncode == 0, installed.stderr
        yield python


def _pip(python, *arguments):
    # Its settings (an index of one's own) may stand in the environment; where to find modules may not.
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    command = [python, "-m", "pip", "--quiet", "--disable-pip-version-check", *arguments]
    return subprocess.run(command, cwd=python.parent, env=environment, capture_output=True, text=True, check=False)
