"""Rules of the house that a machine can check: rooms, quick imports, stubs, length of files."""

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from interreflect import _core

ROOT = Path(__file__).parents[1]
CORE = ROOT / "cpp" / "interreflect"
# A room includes only itself and rooms above it (DESIGN.md); the last five never know each other.
ABOVE = {
    "data": {"math"},
    "math": {"data"},
    "visibility": {"data", "math"},
    "shading": {"data", "math", "visibility"},
    "voxels": {"data", "math", "visibility", "shading"},
    "direct": {"data", "math", "visibility", "shading", "voxels"},
    "caches": {"data", "math", "visibility", "shading", "voxels", "direct"},
    "light_volumes": {"data", "math", "visibility", "shading", "voxels", "direct"},
    "reference": {"data", "math", "visibility", "shading", "voxels", "direct"},
    "surfels": {"data", "math", "visibility", "shading", "voxels", "direct"},
    "virtual_lights": {"data", "math", "visibility", "shading", "voxels", "direct"},
}


def test_a_room_includes_only_rooms_above_it():
    sources = [path for path in CORE.rglob("*.[hc]*") if path.is_file()]
    assert len(sources) > 20
    for source in sources:
        room = source.relative_to(CORE).parts[0]
        for included in re.findall(r'#include "([a-z_]+)/', source.read_text()):
            assert included == room or included in ABOVE[room], f"{source.relative_to(ROOT)} includes {included}/"


def test_only_visibility_knows_the_ray_library():
    for source in CORE.rglob("*.[hc]*"):
        if source.relative_to(CORE).parts[0] != "visibility":
            assert "embree" not in source.read_text().lower(), source


def test_no_file_is_longer_than_400_lines():
    tracked = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    lengths = {name: len((ROOT / name).read_text().splitlines()) for name in tracked if name.endswith((".py", ".h", ".cpp"))}
    assert not {name: lines for name, lines in lengths.items() if lines > 400}


@pytest.mark.parametrize("heavy", ["pandas", "matplotlib", "OpenImageIO", "trimesh", "scipy", "skimage", "interreflect._core"])
def test_import_loads_nothing_heavy(heavy):
    """What makes `import interreflect` and `--help` quick; their times stand in the benchmarks."""
    code = f"import sys, interreflect, interreflect.cli; sys.exit({heavy!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_there_is_one_version():
    with (ROOT / "pyproject.toml").open("rb") as settings:
        version = tomllib.load(settings)["project"]["version"]
    built = re.search(r"^project\(interreflect VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
    cited = re.search(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(), re.MULTILINE)
    newest = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert {found and found[1] for found in (built, cited, newest)} == {version}
    assert _core.build_info["version"] == version


def test_the_citation_names_the_papers():
    yaml = pytest.importorskip("yaml", reason="needs a reader of YAML, which the extra `distributed` brings")
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert citation["cff-version"] == "1.2.0" and {"message", "title", "authors", "license"} <= citation.keys()
    assert {paper["authors"][0]["family-names"] for paper in citation["references"]} == {"Freed", "Jendersie", "Rehfeld", "Weinzierl-Heigl"}
    assert all({"type", "title", "year"} <= paper.keys() for paper in citation["references"])


@pytest.mark.parametrize("document", ["README.md", "CONTRIBUTING.md", "THIRD_PARTY.md"])
def test_links_of_the_documents_lead_somewhere(document):
    text = (ROOT / document).read_text()
    linked = [target for target in re.findall(r"\]\(([^)#]+)\)", text) if "://" not in target]
    assert linked or document == "THIRD_PARTY.md"
    assert [target for target in (*linked, *re.findall(r"`(licenses/[^`]+\.txt)`", text)) if not (ROOT / target).exists()] == []


def test_the_stub_describes_the_module():
    pytest.importorskip("pybind11_stubgen", reason="needs the extra `dev`")
    sys.path.insert(0, str(ROOT / "tools"))
    from stubs import make_stub

    assert (ROOT / "python" / "interreflect" / "_core.pyi").read_text() == make_stub(), "run ./run stubs"
