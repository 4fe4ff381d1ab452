"""The cache folder, and loaded scenes kept in it."""

import os
from pathlib import Path

import numpy as np
import pytest

from interreflect import cache
from interreflect.scenes import load, mapped, scene_cache
from interreflect.scenes.stored import read_stored, write_scene
from interreflect.scenes.values import Camera, EnvironmentLight, Mask, Material, Mesh, PointLight, Scene, Texture

COLUMNS = 12


@pytest.fixture(autouse=True)
def cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "cache"))
    monkeypatch.setattr(scene_cache, "LEAST_BYTES", 2000)  # so that a small grid is large enough to be kept
    return tmp_path / "cache"


@pytest.fixture
def manifest(tmp_path: Path) -> Path:
    """A scene of a grid with its own .mtl, in a folder of its own."""
    folder = tmp_path / "scenes" / "grid"
    folder.mkdir(parents=True)
    n = COLUMNS
    vertices = "".join(f"v {x} {y} 0\nvt {x / n} {y / n}\n" for y in range(n + 1) for x in range(n + 1))
    corners = [(y * (n + 1) + x + 1, y * (n + 1) + x + 2, (y + 1) * (n + 1) + x + 2) for y in range(n) for x in range(n)]
    faces = "".join(f"f {a}/{a} {b}/{b} {c}/{c}\n" for a, b, c in corners)
    (folder / "grid.obj").write_text(f"mtllib grid.mtl\n{vertices}usemtl stone\n{faces}")
    (folder / "grid.mtl").write_text("newmtl stone\nKd 0.2 0.4 0.6\nmap_Kd missing.png\n")
    (folder / "scene.toml").write_text('name = "grid"\n[[geometry]]\nfile = "grid.obj"\n')
    return folder / "scene.toml"


def every_kind_of_value() -> Scene:
    rng = np.random.default_rng(3)
    material = Material(
        albedo_map=Texture(rng.integers(0, 255, (4, 3, 3), np.uint8)),
        emission=(1, 2, 3),
        emission_map=Texture(rng.random((2, 2, 3), np.float32)),
        mask=Mask(rng.random((5, 2)) > 0.5),
        lobe="phong",
        exponent=7.25,
        name="all",
    )
    positions = rng.random((6, 3), np.float32)
    mesh = Mesh(positions, [[0, 1, 2], [3, 4, 5]], texcoords=positions[:, :2], normals=positions + 1, material=material, body="car")
    lights = [PointLight(position=(0, 1, 2), intensity=(1, 2, 3)), EnvironmentLight(image=rng.random((2, 4, 3), np.float32), rotation=12)]
    cameras = {"a": Camera(position=(0, 0, 3), target=(0, 0, 0), fov_x=40, size=(320, 200))}
    scene = Scene(meshes=[mesh, Mesh(positions, [[0, 1, 2]])], lights=lights, cameras=cameras, name="n", unit=0.01, warnings=["odd"])
    return scene.instance("car", [np.eye(4)])


def test_a_stored_scene_is_the_scene_and_shares_its_arrays(tmp_path: Path) -> None:
    scene = every_kind_of_value()
    with open(tmp_path / "a.scene", "wb") as file:
        write_scene(scene, file)
    again = read_stored(tmp_path / "a.scene")
    fresh = Scene(meshes=again.meshes, lights=again.lights, up=again.up)
    assert fresh.hash == scene.hash  # computed from the arrays that were read, not from the stored digest
    assert again == scene and again.cameras == scene.cameras and again.warnings == scene.warnings and again.unit == scene.unit
    assert again.meshes[0].positions is again.meshes[2].positions and again.meshes[0].material.name == "all"


def test_arrays_of_a_stored_scene_stay_in_its_file_and_outlive_it(tmp_path: Path) -> None:
    scene, path = every_kind_of_value(), tmp_path / "a.scene"
    with open(path, "wb") as file:
        write_scene(scene, file)
    again = read_stored(path)
    path.unlink()
    _ = again.core  # lets go of the file's pages
    assert isinstance(mapped.file_of(again.meshes[0].positions), mapped.MappedFile)
    assert isinstance(mapped.file_of(again.meshes[0].material.albedo_map.pixels), mapped.MappedFile)
    assert np.array_equal(again.meshes[0].positions, scene.meshes[0].positions)
    assert not again.meshes[0].positions.flags.writeable
    with pytest.raises(ValueError):
        again.meshes[0].positions.flags.writeable = True


@pytest.mark.parametrize("at", [3, 40, 200, -5])
def test_a_stored_scene_with_any_byte_changed_is_refused(tmp_path: Path, at: int) -> None:
    path = tmp_path / "a.scene"
    with open(path, "wb") as file:
        write_scene(every_kind_of_value(), file)
    data = bytearray(path.read_bytes())
    data[at] ^= 1
    path.write_bytes(data)
    with pytest.raises(ValueError, match="damaged"):
        read_stored(path)


def test_a_loaded_scene_is_kept_and_found_again(manifest: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = load.load_scene(manifest)
    monkeypatch.setattr(load, "read_scene", lambda *a: pytest.fail("read again"))
    second = load.load_scene(manifest)
    assert second == first and second.warnings == first.warnings and second.triangles == COLUMNS**2


@pytest.mark.parametrize("name", ["scene.toml", "grid.obj", "grid.mtl"])
def test_a_change_of_any_file_makes_another_scene(manifest: Path, name: str) -> None:
    load.load_scene(manifest)
    path = manifest.parent / name
    status = path.stat()
    added = {"scene.toml": "up = [0, 0, 1]\n" + path.read_text(), "grid.obj": path.read_text() + "f 1 2 3\n"}
    path.write_text(added.get(name, path.read_text().replace("0.2", "0.3")))
    os.utime(path, ns=(status.st_atime_ns, status.st_mtime_ns))  # content counts, not dates
    kept = load.load_scene(manifest)
    assert kept.hash == load.read_scene(str(manifest)).hash


def test_a_missing_texture_that_appears_makes_another_scene(manifest: Path) -> None:
    assert "missing.png" in load.load_scene(manifest).warnings[0]
    oiio = pytest.importorskip("OpenImageIO")
    image = oiio.ImageOutput.create(str(manifest.parent / "missing.png"))
    image.open(str(manifest.parent / "missing.png"), oiio.ImageSpec(2, 2, 3, "uint8"))
    image.write_image(np.full((2, 2, 3), 80, np.uint8))
    image.close()
    scene = load.load_scene(manifest)
    assert not scene.warnings and scene.meshes[0].material.albedo_map is not None


def test_a_damaged_entry_is_set_aside_and_made_anew(manifest: Path, cache_folder: Path) -> None:
    scene = load.load_scene(manifest)
    (kept,) = cache_folder.glob("scenes/*.scene")
    kept.write_bytes(kept.read_bytes()[:-100])
    assert load.load_scene(manifest) == scene
    assert kept.exists() and kept.with_name(kept.name + ".damaged").exists()


@pytest.mark.parametrize("content", [b"", b"{}", b"[1]", b'{"format":1,"checksum":"","content":["../../../x"]}'])
def test_a_damaged_list_of_files_is_no_obstacle(manifest: Path, cache_folder: Path, content: bytes) -> None:
    scene = load.load_scene(manifest)
    (listed,) = cache_folder.glob("scenes/*.files")
    listed.write_bytes(content)
    assert load.load_scene(manifest) == scene


def test_small_scenes_are_not_kept(tmp_path: Path, cache_folder: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    load.load_scene(tmp_path / "a.obj")
    assert not cache_folder.exists()


def test_a_folder_that_cannot_be_written_is_a_warning(manifest: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("INTERREFLECT_CACHE", str(tmp_path / "file"))
    with pytest.warns(RuntimeWarning, match="cannot be written"):
        assert load.load_scene(manifest).triangles == COLUMNS**2


def fill(name: str, size: int, used: float) -> Path:
    path = cache.folder("things") / name
    assert cache.write(path, lambda file: file.write(b"x" * size))
    os.utime(path, (used, used))
    return path


def test_the_least_recently_used_go_first() -> None:
    old, middle, new = (fill(name, 100, used) for name, used in (("old", 10), ("middle", 20), ("new", 30)))
    cache.touch(old)
    assert cache.trim(250) == 1
    assert old.exists() and not middle.exists() and new.exists()


def test_clear_removes_one_kind_or_all() -> None:
    fill("a", 10, 1)
    assert cache.write(cache.folder("others") / "b", lambda file: file.write(b"yy"))
    assert [entry.kind for entry in cache.entries()] == ["things", "others"]
    assert cache.clear("things") == 1 and [entry.bytes for entry in cache.entries()] == [2]
    assert cache.clear() == 1 and cache.entries() == []


def test_a_writer_that_fails_leaves_nothing() -> None:
    def half(file) -> None:
        file.write(b"half")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        cache.write(cache.folder("things") / "a", half)
    assert list(cache.folder().rglob("*")) == [cache.folder("things")]


def test_the_loader_itself_is_part_of_the_key(manifest: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    load.load_scene(manifest)
    assert scene_cache.cached(str(manifest)) is not None
    monkeypatch.setattr(scene_cache, "_sources", lambda: "another loader")
    assert scene_cache.cached(str(manifest)) is None
