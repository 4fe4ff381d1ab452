"""A wheel carries every library it needs but the C and C++ run-time libraries, and renders where nothing else is installed."""

import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
RUN_TIME = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2"}
RENDER = """
import sys
import interreflect as ir
frame = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=16)).render(ir.scenes.cornell_box(), size=(32, 24))
assert frame.image.shape == (24, 32, 3) and frame.image.mean() > 0.01
assert ir.__file__.startswith(sys.prefix), ir.__file__
"""


def tracked(*folders):
    listed = subprocess.run(["git", "ls-files", *folders], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(listed.stdout.split())


def test_the_wheel_holds_the_package_its_libraries_and_their_licences(wheel_path):
    names = {name for name in zipfile.ZipFile(wheel_path).namelist() if not name.endswith("/")}
    ours = {name.removeprefix("python/") for name in tracked("python/interreflect")}
    package = {name for name in names if name.startswith("interreflect/")}
    (module,) = (name for name in package if name.endswith(".so"))
    assert package - {module} == ours and {"interreflect/py.typed", "interreflect/_core.pyi"} <= ours
    libraries = sorted(re.sub(r"-\w+\.so.*", "", Path(name).name) for name in names if name.startswith("interreflect.libs/"))
    assert libraries == ["libembree3", "libhwy", "libtbb"]
    rest = {name.split("/", 1)[1] for name in names - package if not name.startswith("interreflect.libs/")}
    assert rest >= {"METADATA", "licenses/LICENSE", "licenses/THIRD_PARTY.md", "licenses/licenses/Apache-2.0.txt"}
    (path,) = (name for name in names if name.endswith("licenses/THIRD_PARTY.md"))
    notice = zipfile.ZipFile(wheel_path).read(path).decode()
    assert all(name in notice for name in ("Embree", "oneTBB", "Highway", "GLM", "pybind11"))


def test_the_wheel_names_the_oldest_system_it_runs_on(wheel_path):
    version = re.search(r"-manylinux_2_(\d+)_x86_64\.whl$", wheel_path.name)
    assert version and int(version[1]) <= 36  # of Debian 12, where wheels are made


def test_the_module_that_developers_use_needs_no_building_after_a_wheel(maker, wheel_path):
    again = ["cmake", "--build", str(maker.build_folder()), "--target", "_core"]
    assert "no work to do" in subprocess.run(again, capture_output=True, text=True, check=True).stdout


def test_libraries_of_the_wheel_need_only_each_other_and_the_run_time_libraries(wheel_path, tmp_path):
    zipfile.ZipFile(wheel_path).extractall(tmp_path)
    libraries = list(tmp_path.rglob("*.so*"))
    assert len(libraries) == 4
    for library in libraries:
        dynamic = subprocess.run(["readelf", "-d", library], capture_output=True, text=True, check=True).stdout
        needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", dynamic))
        assert needed <= RUN_TIME | {path.name for path in libraries}, library
        paths = re.findall(r"\((?:RPATH|RUNPATH)\).*\[(.+)\]", dynamic)
        assert all(path.startswith("$ORIGIN") for found in paths for path in found.split(":")), paths


def test_the_wheel_renders_in_a_bare_environment_and_loads_nothing_from_outside(bare_python, tmp_path):
    """The loader tells which library asked for which, and which ones it found."""
    environment = {"PATH": "/usr/bin:/bin", "XDG_CACHE_HOME": str(tmp_path)}
    environment |= {"LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(tmp_path / "loader")}
    done = subprocess.run([bare_python, "-I", "-c", RENDER], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    told = "".join(path.read_text() for path in tmp_path.glob("loader.*"))
    asked = {
        (Path(name).name, Path(asking).name)
        for name, asking in re.findall(r"file=(\S+) \[0\];\s+(?:needed|dynamically loaded) by (\S+)", told)
        if "/interreflect/" in asking
    }
    loaded = {Path(name).name for name in re.findall(r"file=(\S+) \[0\];\s+generating link map", told)}
    libraries = {path.name for path in bare_python.parents[1].rglob("interreflect.libs/*")}
    used = {name for name, _ in asked if name in loaded}
    assert used - RUN_TIME == libraries and len(libraries) == 3, used


def test_the_archive_of_sources_holds_what_a_build_needs_and_no_more(maker, tmp_path):
    archive = maker.build_sdist(tmp_path)
    with tarfile.open(archive) as packed:
        names = {name.split("/", 1)[1] for name in packed.getnames()}
    sources = tracked("cpp/*.h", "cpp/*.cpp", "python/interreflect", "cmake")
    beside = {"CMakeLists.txt", "pyproject.toml", "README.md", "CHANGELOG.md", "LICENSE", "THIRD_PARTY.md"} | tracked("licenses")
    assert names - {"PKG-INFO"} == sources | beside


@pytest.mark.long
def test_a_wheel_is_built_from_the_archive_of_sources(maker, tmp_path):
    archive = maker.build_sdist(tmp_path)
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", tmp_path, archive]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and len(list(tmp_path.glob("*.whl"))) == 1, done.stderr
