""".obj and .mtl: what they say is what is loaded."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from scene_files import TRIANGLE, write, write_image

from interreflect.errors import SceneError
from interreflect.scenes.load import read_scene
from interreflect.scenes.values import Scene


def load(folder: Path, text: str, **files: str | bytes) -> Scene:
    return read_scene(str(write(folder, a_obj=text, **files) / "a.obj"))


def corners(scene: Scene) -> np.ndarray:
    """(m, 3, 3) positions of all triangles, in order."""
    return np.concatenate([mesh.positions[mesh.triangles] for mesh in scene.meshes])


def test_polygons_become_fans(tmp_path: Path) -> None:
    scene = load(tmp_path, "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 1 2 0\nv -1 1 0\nf 1 2 3 4 5\nf 1 2 3\n")
    expected = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2]]
    points = np.array([[0, 0, 0], [2, 0, 0], [3, 1, 0], [1, 2, 0], [-1, 1, 0]])
    assert np.array_equal(corners(scene), points[expected])


@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_white_space_comments_and_continued_lines_do_not_matter(tmp_path: Path, newline: str) -> None:
    text = "# head\n\n  v 0\t0 0 # origin\nv 1 0 0 1\nv   0 1 0 .5 .5 .5 \ng a#b\n\tf 1 \\\n 2 3   # a face\n#f 1 2 2"
    assert np.array_equal(corners(load(tmp_path, text.replace("\n", newline))), [[[0, 0, 0], [1, 0, 0], [0, 1, 0]]])


def test_negative_indices_count_back_from_their_own_line(tmp_path: Path) -> None:
    scene = load(tmp_path, TRIANGLE + "f -3 -2 -1\nv 5 5 5\nf -4 -3 -1\n")
    assert np.array_equal(corners(scene), [[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 0, 0], [1, 0, 0], [5, 5, 5]]])


def test_corners_with_and_without_attributes_keep_what_they_have(tmp_path: Path) -> None:
    text = TRIANGLE + "v 1 1 0\nvt 0.5 0.25\nvn 0 0 -1\nf 1 2 3\nf 1/1/1 2/1/1 4/1/1\nf 1//1 3//1 4//1\nf 2/1 3/1 4/1\nf 1/1/1 2 4/1/1\n"
    scene = load(tmp_path, text)
    found = {(mesh.texcoords is not None, mesh.normals is not None): len(mesh.triangles) for mesh in scene.meshes}
    assert found == {(False, False): 2, (True, True): 1, (False, True): 1, (True, False): 1}  # the mixed face has neither
    mesh = next(mesh for mesh in scene.meshes if mesh.texcoords is not None and mesh.normals is not None)
    assert np.array_equal(mesh.texcoords, [[0.5, 0.25]] * 3) and np.array_equal(mesh.normals, [[0, 0, -1]] * 3)


def test_equal_corners_are_one_vertex_and_seams_stay(tmp_path: Path) -> None:
    text = TRIANGLE + "v 1 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 3/1 2/1 4/1\nf 1/2 2/2 4/2\n"
    (mesh,) = load(tmp_path, text).meshes
    assert len(mesh.positions) == 4 + 3


def test_materials_of_one_name_are_one_mesh_whatever_the_order(tmp_path: Path) -> None:
    text = "mtllib m.mtl\n" + TRIANGLE + "usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\nusemtl a\nf 2 3 1\n"
    scene = load(tmp_path, text, m_mtl="newmtl a\nKd 1 0 0\nnewmtl b\nKd 0 1 0\n")
    assert [(mesh.material.name, len(mesh.triangles)) for mesh in scene.meshes] == [("a", 2), ("b", 1)]


def test_an_mtl_is_read_as_the_format_says(tmp_path: Path) -> None:
    write_image(tmp_path / "red wall.png", np.full((2, 2, 3), (200, 10, 10), np.uint8))
    mtl = (
        "newmtl a # the first\n  Kd 0.1 0.2 0.3 # trailing\n\tKs 0.4 0.4 0.4\nNs 12.5\nKe 1 2 3\nd 0.5\nTr 0.5\nillum 7\nNi 1.5\n"
        "map_bump x.png\nmap_Kd -bm 1 red wall.png\nnewmtl b\nNs 0\nKs 0.1 0.1 0.1\n"
    )
    text = "mtllib m.mtl\n" + TRIANGLE + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 1 2 3\n"
    scene = load(tmp_path, text, m_mtl=mtl)
    a, b = (mesh.material for mesh in scene.meshes)
    assert (a.albedo, a.specular, a.exponent, a.emission) == ((0.1, 0.2, 0.3), (0.4, 0.4, 0.4), 12.5, (1, 2, 3))
    assert a.lobe == "ggx" and a.albedo_map is not None and a.albedo_map.pixels[0, 0].tolist() == [200, 10, 10]
    assert b.roughness == 1 and b.exponent is None  # alpha = sqrt(2 / (0 + 2))


def test_a_missing_texture_is_as_without_a_map_with_a_warning(tmp_path: Path) -> None:
    text = "mtllib m.mtl\nusemtl a\n" + TRIANGLE + "vt 0 0\nf 1/1 2/1 3/1\n"
    scene = load(tmp_path, text, m_mtl="newmtl a\nmap_Kd nowhere.png\n")
    assert scene.meshes[0].material.albedo == (0.5, 0.5, 0.5) and scene.meshes[0].material.albedo_map is None
    assert len(scene.warnings) == 1 and "nowhere.png" in scene.warnings[0] and "m.mtl:2" in scene.warnings[0]


def test_a_map_without_texture_coordinates_is_dropped_with_a_warning(tmp_path: Path) -> None:
    write_image(tmp_path / "t.png", np.zeros((1, 1, 3), np.uint8))
    scene = load(tmp_path, "mtllib m.mtl\nusemtl a\n" + TRIANGLE + "f 1 2 3\n", m_mtl="newmtl a\nmap_Kd t.png\nmap_d t.png\n")
    assert scene.meshes[0].material.albedo_map is None and scene.meshes[0].material.mask is None
    assert [w.partition("/")[2] for w in scene.warnings] == ["a.obj: material 'a': 2 maps dropped for want of texture coordinates"]


def test_zero_area_triangles_are_dropped_and_counted(tmp_path: Path) -> None:
    scene = load(tmp_path, TRIANGLE + "v 2 0 0\nf 1 1 1\nf 1 2 3\nf 1 2 4\n")
    assert scene.triangles == 1 and "2 triangles without area dropped" in scene.warnings[0]
    assert len(scene.meshes[0].positions) == 3


def test_zero_length_normals_are_recomputed_and_counted(tmp_path: Path) -> None:
    scene = load(tmp_path, TRIANGLE + "vn 0 0 0\nvn 0 3 0\nf 1//1 2//1 3//2\n")
    normals = scene.meshes[0].normals
    assert normals is not None and sorted(map(tuple, normals.tolist())) == [(0, 0, 1), (0, 0, 1), (0, 1, 0)]
    assert "2 normals without length recomputed" in scene.warnings[0]


def test_a_file_of_zero_area_triangles_only_is_an_empty_scene(tmp_path: Path) -> None:
    scene = load(tmp_path, TRIANGLE + "f 1 1 2\n")
    assert scene.triangles == 0 and len(scene.warnings) == 1


@pytest.mark.parametrize("size", [1e-6, 1e9])
def test_small_and_large_extents_load(tmp_path: Path, size: float) -> None:
    scene = load(tmp_path, f"v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nf 1 2 3\n")
    assert scene.triangles == 1 and np.allclose(scene.bounds[1], [size, size, 0])


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("f 1 2 99", 4, "index 99 of v is out of range"),
        ("f 1 2 3000000000", 4, "out of range"),
        ("f 1 2 99999999999999999999", 4, "out of range"),
        ("f -1 -2 -9", 4, "out of range"),
        ("f 0 1 2", 4, "index 0 of v is out of range"),
        ("f 1/1 2/1 3/1", 4, "index 1 of vt is out of range"),
        ("vn 0 0 1\nf 1//1 2//1 3//2", 5, "index 2 of vn is out of range"),
        ("vt 0 0\nf 1/0 2/1 3/1", 5, "index 0 of vt is out of range"),
        ("f 1 2", 4, "at least three corners"),
        ("f", 4, "at least three corners"),
        ("f 1 2 x", 4, "whole numbers"),
        ("f 1 2 3.5", 4, "whole numbers"),
        ("f 1/1/1/1 2 3", 4, "at most three indices"),
        ("f /1 2 3", 4, "must have a position"),
        ("v 1 2\nf 1 2 3", 4, "v must have 3 numbers"),
        ("v abc 0 0\nf 1 2 3", 4, "v must be numbers"),
        ("v 1e999 0 0\nf 1 2 3", 4, "v must be finite"),
        ("v 1e39 0 0\nf 1 2 3", 4, "v must be finite"),
        ("v nan 0 0\nf 1 2 3", 4, "v must be finite"),
        ("v 0 0 -inf\nf 1 2 3", 4, "v must be finite"),
        ("vt nan\nf 1 2 3", 4, "vt must be finite"),
        ("vn 0 0\nf 1 2 3", 4, "vn must have 3 numbers"),
        ("v 0,5 0 0\nf 1 2 3", 4, "v must be numbers"),
        ("hello\nf 1 2 3", 4, "no statement of an .obj"),
        ("\0\1\2", 4, "no statement of an .obj"),
        ("usemtl nobody\nf 1 2 3", None, "material 'nobody' is not defined"),
        ("mtllib ../../x.mtl\nf 1 2 3", 4, "must not lead above"),
        ("mtllib http://example.org/x.mtl\nf 1 2 3", 4, "without a scheme"),
        ("", None, "holds no faces"),
    ],
)
def test_what_is_malformed_is_refused_with_its_line(tmp_path: Path, text: str, line: int | None, message: str) -> None:
    with pytest.raises(SceneError, match=message) as error:
        load(tmp_path / "in" / "side", TRIANGLE + text + "\n")
    assert str(error.value).startswith("side/a.obj" + (f":{line}:" if line else ":"))


@pytest.mark.parametrize(
    ("mtl", "message"),
    [
        ("newmtl a\nKd red 0 0\n", r"m.mtl:2: Kd must be numbers"),
        ("newmtl a\nKd 0.5 nan 0\n", r"m.mtl:2: Kd must be finite"),
        ("newmtl a\nKd 0.5 0.5\n", r"m.mtl:2: Kd must be three numbers"),
        ("newmtl a\nKd 0.5 -0.5 0\n", r"m.mtl:2: Kd must be three numbers of at least 0"),
        ("newmtl a\nKd 0.5 0.5 7\n", r"material 'a'.albedo must be three numbers in \[0, 1\]"),
        ("newmtl a\nNs -3\n", r"m.mtl:2: Ns must be a number of at least 0"),
        ("newmtl a\nmap_Kd /etc/hostname\n", r"m.mtl:2: map_Kd must be a relative path"),
        ("newmtl a\nmap_Kd ../../../etc/hostname\n", r"m.mtl:2: map_Kd must not lead above"),
        ("newmtl a\nmap_Kd C:\\x.png\n", r"m.mtl:2: map_Kd must be a relative path without a scheme"),
        ("newmtl a\nmap_Kd\n", r"m.mtl:2: map_Kd must be a file name"),
        ("newmtl a\nmap_Kd m.mtl\n", r"m.mtl: is no image that can be read"),
    ],
)
def test_a_malformed_material_is_refused_with_its_line(tmp_path: Path, mtl: str, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        load(tmp_path / "in" / "side", "mtllib m.mtl\nusemtl a\n" + TRIANGLE + "vt 0 0\nf 1/1 2/1 3/1\n", m_mtl=mtl)


def test_thousands_of_materials_and_repeated_libraries_load_in_bounded_time(tmp_path: Path) -> None:
    many = 5000
    text = TRIANGLE + "mtllib m.mtl\n" * many + "".join(f"usemtl a{k}\nf 1 2 3\n" for k in range(many)) * 2
    scene = load(tmp_path, text, m_mtl="".join(f"newmtl a{k}\nKd 0.5 0.5 0.5\n" for k in range(many)))
    assert len(scene.meshes) == many and scene.triangles == 2 * many


def test_trimesh_reads_the_same_triangles_from_a_clean_file(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    points, faces = rng.random((500, 3)), rng.integers(1, 501, (900, 3))
    text = "".join(f"v {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in points) + "".join(f"f {a} {b} {c}\n" for a, b, c in faces)
    ours = corners(load(tmp_path, text))
    theirs = trimesh.load(tmp_path / "a.obj", process=False)
    kept = [len({a, b, c}) == 3 for a, b, c in faces]  # theirs keeps triangles without area
    assert np.allclose(ours, np.asarray(theirs.vertices)[np.asarray(theirs.faces)][kept], atol=1e-7)
