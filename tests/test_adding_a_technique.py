"""The page on adding a technique, word by word: its blocks are applied to a copy of the sources, built, and end in a chart.

Only what depends on the changed page of the stage is compiled; the rest is linked from the objects of the build that the tests ran.
"""

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
PAGE = (ROOT / "docs" / "adding_a_technique.md").read_text()
# An editable install may put a finder before PYTHONPATH (scikit-build-core does since 1.1); in the copy, the copy is meant.
WITHOUT_THE_INSTALLED = (
    "import sys\nsys.meta_path[:] = [finder for finder in sys.meta_path if 'interreflect' not in type(finder).__module__]\n"
)
SMALLER = {"(160, 120)": "(32, 24)", "range(3)": "range(2)", "max_spp=512": "max_spp=16", "[0.25, 0.5, 1, 2, 4]": "[0.25, 4]"}


def built():
    """The folder of the newest build that made the module in place."""
    found = [path.parent for path in (*ROOT.glob("build/*/build.ninja"), *ROOT.glob("build/build.ninja"))]
    found = [path for path in found if (path / "libinterreflect_core.a").exists() and (path / "CMakeFiles/_core.dir").exists()]
    if not found:
        pytest.skip("needs a build of the module with Ninja (./run test makes one)")
    return max(found, key=lambda path: (path / "libinterreflect_core.a").stat().st_mtime)


def dependents(build, header):
    """Objects that were compiled from something that includes the header, as Ninja noted it."""
    noted = subprocess.run(["ninja", "-C", str(build), "-t", "deps"], capture_output=True, text=True, check=True).stdout
    groups = (group for group in noted.split("\n\n") if group.strip())
    return {group.partition(":")[0].strip() for group in groups if any(line.strip().endswith(header) for line in group.splitlines()[1:])}


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    """A copy of the repository with steps 1 and 2 of the page done, and the core built from it."""
    build, folder = built(), tmp_path_factory.mktemp("added")
    for name in ("cpp", "python", "docs", "tools", "tests"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("*.so", "__pycache__"))
    (path,) = re.findall(r"^`(cpp/\S+soft_disk\.h)`$", PAGE, re.MULTILINE)
    (header,) = re.findall(r"```cpp\n(.*?)```", PAGE, re.DOTALL)
    (folder / path).write_text(header)
    (folder / "python" / "sitecustomize.py").write_text(WITHOUT_THE_INSTALLED)
    (change,) = re.findall(r"```diff\n(.*?)```", PAGE, re.DOTALL)
    subprocess.run(["patch", "-p1"], cwd=folder, input=change, text=True, check=True)
    link(build, folder, compile_changed(build, folder, "cpp/interreflect/virtual_lights/shade.h"))
    return folder


def compile_changed(build, folder, header):
    """Old object -> new one, of everything of the module that the header reaches; two at a time."""
    wanted = {name for name in dependents(build, header) if "core_tests" not in name}
    made, running = {}, []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        name = entry.get("output") or shlex.split(entry["command"])[shlex.split(entry["command"]).index("-o") + 1]
        if name in wanted and "_core.dir" in name:
            new = folder / Path(name).name
            command = entry["command"].replace(f"{ROOT}/cpp", f"{folder}/cpp").replace(f"-o {name}", f"-o {new}")
            running.append(subprocess.Popen(command, shell=True, cwd=entry["directory"]))
            made[name] = str(new)
    assert len(made) >= 2 and not any(process.wait() for process in running)
    return made


def link(build, folder, made):
    """As Ninja links the module: new objects in place of the module's old ones, and before the core's archive."""
    commands = subprocess.run(["ninja", "-C", str(build), "-t", "commands", "_core"], capture_output=True, text=True, check=True)
    words = shlex.split(commands.stdout.strip().splitlines()[-1].removeprefix(": &&").partition("&&")[0])
    target = folder / "python" / "interreflect" / Path(words[words.index("-o") + 1]).name
    words[words.index("-o") + 1] = str(target)
    words = [made.get(word, word) for word in words]
    archive = words.index("libinterreflect_core.a")
    words[archive:archive] = [new for new in made.values() if new not in words]
    subprocess.run(words, cwd=build, check=True)


def run(copy, *command):
    environment = {**os.environ, "PYTHONPATH": f"{copy / 'python'}:{copy}", "INTERREFLECT_CACHE": str(copy / "cache")}
    return subprocess.run([sys.executable, *command], cwd=copy, env=environment, capture_output=True, text=True, check=False)


def test_the_page_on_adding_a_technique_ends_in_a_chart(copy):
    code = "\n".join(re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL))
    for long, short in SMALLER.items():
        assert long in code
        code = code.replace(long, short)
    done = run(copy, "-c", code)
    assert done.returncode == 0, done.stderr
    assert "SoftDisk.softness must lie in [0, 100]" in done.stdout and "DiskIntegral()" in done.stdout
    assert (copy / "soft_disk.png").read_bytes().startswith(b"\x89PNG")
    errors = dict(re.findall(r"^(\w+)\s+\S+\s+([\d.e-]+)$", done.stdout, re.MULTILINE))
    assert set(errors) >= {"SoftDisk", "PointToDisk", "DiskIntegral"}


def test_an_added_technique_meets_its_contracts_and_has_stubs_and_a_page(copy):
    assert "interreflect.SoftDisk" in run(copy, "-c", "import interreflect as ir; print(ir.SoftDisk)").stdout.replace("_core.", "")
    tests = ["tests/contracts/test_techniques.py", "tests/contracts/test_virtual_light_pairs.py"]
    done = run(copy, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-k", "SoftDisk", *tests)
    assert re.search(r"\d+ passed", done.stdout) and done.returncode == 0, done.stdout
    assert run(copy, "tools/stubs.py", "stubs.pyi").returncode == 0
    assert "class SoftDisk" in (copy / "stubs.pyi").read_text()
    page = "from docs.generate.technique_pages import technique_page; import interreflect as ir; print(technique_page(ir.SoftDisk))"
    assert "how much of the area bounds the light" in run(copy, "-c", page).stdout
