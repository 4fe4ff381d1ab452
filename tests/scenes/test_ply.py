""".ply: every encoding gives the same triangles, and a header promises nothing that the file does not hold."""

import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from interreflect.errors import SceneError
from interreflect.scenes.load import read_scene
from interreflect.scenes.values import Mesh

VERTICES = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0.5)]
FACES = [(0, 1, 2), (0, 1, 3, 2), (3, 2, 1)]
MIXED = [(0, 1, 2), (0, 1, 3), (0, 3, 2), (3, 2, 1)]
ENCODINGS = ("ascii", "binary_little_endian", "binary_big_endian")


def header(encoding: str, vertices: int, faces: int, extra: str = "", lists: str = "property list uchar int vertex_indices\n") -> bytes:
    coordinates = "".join(f"property float {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat {encoding} 1.0\ncomment made here\nelement vertex {vertices}\n{coordinates}{extra}"
        f"element face {faces}\n{lists}end_header\n"
    ).encode()


def body(encoding: str, vertices: list[tuple[float, ...]], faces: list[tuple[int, ...]]) -> bytes:
    if encoding == "ascii":
        rows = [" ".join(map(str, v)) for v in vertices] + [" ".join(map(str, (len(f), *f))) for f in faces]
        return ("\n".join(rows) + "\n").encode()
    order = "<" if "little" in encoding else ">"
    data = b"".join(struct.pack(f"{order}{len(v)}f", *v) for v in vertices)
    return data + b"".join(struct.pack(f"{order}B{len(f)}i", len(f), *f) for f in faces)


def load(folder: Path, data: bytes) -> Mesh:
    (folder / "a.ply").write_bytes(data)
    (mesh,) = read_scene(str(folder / "a.ply")).meshes
    return mesh


@pytest.mark.parametrize("encoding", ENCODINGS)
@pytest.mark.parametrize(("faces", "expected"), [(FACES, MIXED), ([FACES[0], FACES[2]], [FACES[0], FACES[2]])])
def test_every_encoding_gives_the_same_triangles(tmp_path: Path, encoding: str, faces: list, expected: list) -> None:
    mesh = load(tmp_path, header(encoding, 4, len(faces)) + body(encoding, VERTICES, faces))
    assert np.array_equal(mesh.positions[mesh.triangles], np.array(VERTICES, np.float32)[expected])


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_normals_and_texture_coordinates_are_read_and_other_properties_ignored(tmp_path: Path, encoding: str) -> None:
    extra = "".join(f"property float {name}\n" for name in ("quality", "nx", "ny", "nz", "s", "t"))
    vertices = [(*v, 9, 0, 0, 2, v[0], v[1]) for v in VERTICES]
    mesh = load(tmp_path, header(encoding, 4, 2, extra) + body(encoding, vertices, [(0, 1, 2), (3, 2, 1)]))
    assert np.allclose(mesh.normals, [[0, 0, 1]] * 4)
    assert np.array_equal(mesh.texcoords, np.array(VERTICES)[:, :2])


def test_faces_with_further_properties_and_elements_between_are_read(tmp_path: Path) -> None:
    head = (
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
        b"element edge 2\nproperty int a\nproperty list uchar float weights\n"
        b"element face 2\nproperty uchar flag\nproperty list ushort ushort vertex_index\nproperty list uchar float texcoord\nend_header\n"
    )
    data = struct.pack("<9d", 0, 0, 0, 1, 0, 0, 0, 1, 0) + struct.pack("<iBfiB", 7, 1, 0.5, 8, 0)
    data += struct.pack("<BH3HB", 1, 3, 0, 1, 2, 0) + struct.pack("<BH3HB2f", 1, 3, 2, 1, 0, 2, 0.5, 0.5)
    assert load(tmp_path, head + data).triangles.tolist() == [[0, 1, 2], [2, 1, 0]]


def test_many_polygons_of_all_sizes_load_in_bounded_time(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    faces = [tuple(range(n)) for n in rng.integers(3, 7, 20_000)]
    vertices = [(np.cos(a), np.sin(a), 0.0) for a in np.arange(6)]
    mesh = load(tmp_path, header("binary_little_endian", 6, len(faces)) + body("binary_little_endian", vertices, faces))
    assert len(mesh.triangles) == sum(len(f) - 2 for f in faces)


GOOD = header("ascii", 4, 1)


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "is no .ply"),
        (b"ply\n", "is no .ply"),
        (b"ply\n" + b"comment x\n" * 100_000, "end_header"),
        (b"ply\nend_header\n", "lacks its format"),
        (b"ply\nformat ascii 1.0\nend_header\n", "lacks element 'vertex'"),
        (b"ply\nformat ascii 1.0\nelement vertex -3\nend_header\n", r":3: no line of a .ply's header"),
        (b"ply\nformat ascii 1.0\nproperty float x\nend_header\n", r":3: no line of a .ply's header"),
        (b"ply\nformat ascii 1.0\nelement vertex 1\nproperty quad x\nend_header\n", r":4: no line of a .ply's header"),
        (b"ply\nformat ascii 1.0\nelement vertex 0\nend_header\n", "must have properties"),
        (header("binary_little_endian", 10**9, 1) + b"\0\0", "ends before the 1000000000 rows of element 'vertex'"),
        (header("binary_little_endian", 0, 10**12), "ends before the 1000000000000 rows of element 'face'"),
        (header("binary_little_endian", 3, 2) + body("binary_little_endian", VERTICES[:3], FACES[:1]), "ends before the 2 rows"),
        (header("binary_little_endian", 3, 1) + bytes(36) + b"\xff\0\0", "cannot have length 255"),
        (header("ascii", 4, 1) + b"0 0 0\n1 0 0\n", "ends before the 4 rows"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 3 0 1", "ends before the 1 rows"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 3 0 1 x", "the body must be numbers"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 3 0 1 1.5", "vertex indices must be whole numbers"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 2.5 0 1 2", "cannot have length 2.5"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 nan 0 1 2", "cannot have length nan"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 1e300 0 1 2", "cannot have length"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 2 0 1", "must have at least three corners, got 2"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 3 0 1 3", r"vertex index must lie in \[0, 3\), got 3"),
        (header("ascii", 3, 1) + b"0 0 0 1 0 0 0 1 0 3 0 1 -1", r"vertex index must lie in \[0, 3\), got -1"),
        (header("ascii", 3, 1) + b"0 0 nan 1 0 0 0 1 0 3 0 1 2", "position 0 must be finite"),
        (header("ascii", 3, 1) + b"0 0 0 1 1e39 0 0 1 0 3 0 1 2", "position 1 must be finite"),
        (header("ascii", 3, 1, lists="property int vertex_indices\n") + b"0 0 0 1 0 0 0 1 0 3", "lack the list vertex_indices"),
        (header("ascii", 3, 1, lists="property list float int vertex_indices\n"), "must be a whole number"),
        (header("ascii", 3, 1, "property float x\n"), "distinct names"),
    ],
)
def test_what_is_malformed_is_refused(tmp_path: Path, data: bytes, message: str) -> None:
    with pytest.raises(SceneError, match=message):
        load(tmp_path, data)


def test_trimesh_reads_the_same_triangles(tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    points = [tuple(p) for p in rng.random((300, 3)).astype(np.float32).tolist()]
    faces = [tuple(rng.permutation(300)[:3].tolist()) for _ in range(500)]
    mesh = load(tmp_path, header("binary_big_endian", 300, 500) + body("binary_big_endian", points, faces))
    theirs = trimesh.load(tmp_path / "a.ply", process=False)
    assert np.array_equal(mesh.positions[mesh.triangles], np.asarray(theirs.vertices, np.float32)[theirs.faces])
