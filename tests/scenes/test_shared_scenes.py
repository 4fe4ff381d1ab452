"""The downloaded scenes: each manifest loads, with the triangles its own page counts, and as an independent reader sees it."""

import importlib.util
import itertools
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

import interreflect.cache as cache
from interreflect.scenes.load import load_scene, read_scene
from interreflect.scenes.values import EnvironmentLight, Scene


def counted(shared_scenes: Path) -> dict[str, int]:
    """Manifest -> triangles, from the table of the scenes' README."""
    result: dict[str, int] = {}
    for line in (shared_scenes / "README.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) < 3 or (".toml" not in cells[1] and "{" not in cells[1]):
            continue
        folder = cells[1].split("/")[0]
        names = [name if name.startswith(folder) else f"{folder}/{name}" for name in _expanded(cells[1])]
        numbers = [int(number.replace(",", "")) for number in cells[2].split(";")]
        result.update(zip(names, itertools.chain(numbers, itertools.repeat(numbers[-1])), strict=False))
    return result


def _expanded(cell: str) -> list[str]:
    braces = re.search(r"\{(.*)\}", cell)
    if braces:
        return [cell[: braces.start()] + name + cell[braces.end() :] for name in braces[1].split(",")]
    return [name.strip() for name in cell.split(",")]


def test_every_manifest_loads_with_the_triangles_its_page_counts(shared_scenes: Path) -> None:
    expected = counted(shared_scenes)
    found = {}
    for path in sorted(shared_scenes.rglob("*.toml")):
        name = path.relative_to(shared_scenes).as_posix()
        scene = read_scene(str(path))
        found[name] = scene.triangles
        assert scene.cameras and np.isfinite(scene.bounds).all(), name
        assert sum(isinstance(light, EnvironmentLight) for light in scene.lights) <= 1
    assert found == expected


def test_sponza_has_its_textures_masks_and_warning(shared_scenes: Path) -> None:
    scene = load_scene(shared_scenes / "sponza_crytek" / "scene.toml")
    textures = {mesh.material.albedo_map for mesh in scene.meshes if mesh.material.albedo_map}
    masks = {mesh.material.mask for mesh in scene.meshes if mesh.material.mask}
    assert len(textures) + len(masks) == 27 and len(masks) == 3
    assert all(texture.pixels.dtype == np.uint8 for texture in textures)
    assert len(scene.warnings) == 1 and "425 triangles without area dropped" in scene.warnings[0]
    assert load_scene(shared_scenes / "sponza_crytek" / "scene.toml") == scene  # from the cache


FIRST_RAY = """
import re, sys, time
begin = time.perf_counter()
import interreflect as ir
scene = ir.load_scene(sys.argv[1])
assert ir.trace_gbuffer(scene, size=(1, 1)).counts is not None
# VmHWM, as getrusage's maximum starts from that of the process that started this one
print(time.perf_counter() - begin, int(re.search(r"VmHWM:\\s+(\\d+) kB", open("/proc/self/status").read())[1]) / 1024)
"""


def first_ray(shared_scenes: Path) -> tuple[float, float]:
    """Seconds from the start of the import to Sponza's first ray, and the process's peak memory in MiB."""
    manifest = shared_scenes / "sponza_crytek" / "scene.toml"
    child = subprocess.run([sys.executable, "-c", FIRST_RAY, str(manifest)], capture_output=True, text=True, check=True)
    seconds, peak = map(float, child.stdout.split())
    return seconds, peak


def test_sponza_to_the_first_ray_stays_below_600_mib_cold_and_cached(shared_scenes: Path) -> None:
    assert first_ray(shared_scenes)[1] < 600
    assert first_ray(shared_scenes)[1] < 600


@pytest.mark.long
def test_sponza_reaches_its_first_ray_in_3_seconds_cold_and_1_second_cached(shared_scenes: Path) -> None:
    """Minima of three, for other processes may run."""
    cold = []
    for _ in range(3):
        cache.clear()
        cold.append(first_ray(shared_scenes)[0])
    assert min(cold) < 3
    assert min(first_ray(shared_scenes)[0] for _ in range(3)) < 1


@pytest.fixture(scope="module")
def witness(shared_scenes: Path) -> ModuleType:
    """A reader of the same format that shares no code with ours."""
    path = shared_scenes.parent / "tools" / "to_mitsuba.py"
    if not path.is_file():
        pytest.skip(f"the independent reader {path.name} is absent")
    spec = importlib.util.spec_from_file_location("to_mitsuba", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def world_soup(scene: Scene) -> dict[str, tuple[np.ndarray, np.ndarray | None, np.ndarray | None]]:
    """Material name -> corners (m, 3, 3), normals and texcoords at them, in world space, triangles in the files' order."""
    soups: dict[str, list] = {}
    for mesh in scene.meshes:
        linear, shift = mesh.transform[:3, :3], mesh.transform[:3, 3]
        corners = mesh.positions[mesh.triangles] @ linear.T + shift
        normals = None
        if mesh.normals is not None:
            normals = mesh.normals[mesh.triangles] @ np.linalg.inv(linear)
            normals /= np.linalg.norm(normals, axis=2, keepdims=True)
        texcoords = None if mesh.texcoords is None else mesh.texcoords[mesh.triangles]
        soups.setdefault(mesh.material.name, []).append((corners, normals, texcoords))
    return {name: _joined(parts) for name, parts in soups.items()}


def _joined(parts: list) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
    columns = [None if any(part[k] is None for part in parts) else np.concatenate([part[k] for part in parts]) for k in range(3)]
    return tuple(columns)  # type: ignore[return-value]


def compare_materials(scene: Scene, manifest: dict, of_file: dict) -> None:
    """The scene's materials against those of one file as the independent reader merges them."""
    tables = manifest.get("material", {})
    for mesh in scene.meshes:
        material = mesh.material
        if material.name not in of_file:
            continue
        over = {**tables.get("*", {}), **tables.get(material.name, {})}
        theirs = {**of_file[material.name], **over}
        if "roughness" in over and "exponent" not in over:
            theirs.pop("exponent", None)
        alpha = np.sqrt(2 / (theirs["exponent"] + 2)) if "exponent" in theirs else theirs.get("roughness", 0.5) ** 2
        ours = np.sqrt(2 / (material.exponent + 2)) if material.exponent is not None else material.roughness**2
        assert np.isclose(ours, alpha)
        if mesh.texcoords is not None or "albedo_map" not in theirs:
            assert np.allclose(material.albedo, theirs.get("albedo", [1.0] * 3 if "albedo_map" in theirs else [0.5] * 3))
            assert (material.albedo_map is not None) == ("albedo_map" in theirs)
        assert np.allclose(material.specular, theirs.get("specular", 0)) and np.allclose(material.emission, theirs.get("emission", 0))


@pytest.mark.parametrize(
    "name",
    [
        "cornell_box/glossy",
        "cornell_box/water",
        "models/bunny",
        "models/suzanne",
        "models/spot",
        "veach_mis/scene",
        "gltf_samples/Suzanne/scene",
        "sponza_dabrovic/scene",
        "veach_ajar/scene",
    ],
)
def test_an_independent_reader_sees_the_same_triangles_normals_texture_coordinates_and_materials(
    shared_scenes: Path, witness: ModuleType, name: str
) -> None:
    path = (shared_scenes / f"{name}.toml").resolve()
    manifest = tomllib.loads(path.read_text())
    scene = read_scene(str(path))
    ours = world_soup(scene)
    soups: dict[str, list] = {}
    files: dict = {}
    for geometry in manifest["geometry"]:
        parts, materials = witness.parts(geometry, str(path.parent), files, [])
        compare_materials(scene, manifest, materials)
        for positions, normals, texcoords, triangles, material in parts:
            transparent = manifest.get("material", {}).get(material, {}).get("transparent", False)
            if len(triangles) and not transparent:
                column = [None if array is None else array[triangles] for array in (positions, normals, texcoords)]
                soups.setdefault(material or "", []).append(column)
    theirs = {material: _joined(parts) for material, parts in soups.items()}
    assert ours.keys() == theirs.keys()
    extent = max(float(np.abs(soup[0]).max()) for soup in theirs.values())
    for material, (corners, normals, texcoords) in ours.items():
        their_corners, their_normals, their_texcoords = theirs[material]
        assert len(corners) == len(their_corners)
        assert np.abs(corners - their_corners).max() < 1e-6 * extent  # float32 against float64
        assert (texcoords is None) == (their_texcoords is None)
        if texcoords is not None:
            assert np.abs(texcoords - their_texcoords).max() < 1e-6 * max(1, float(np.abs(their_texcoords).max()))
        assert (normals is None) == (their_normals is None)
        if normals is not None:
            # nearly degenerate neighbours turn a smooth normal by more than rounding: all but one in a thousand agree
            assert np.quantile(np.abs(normals - their_normals).max(2), 0.999) < 1e-4
