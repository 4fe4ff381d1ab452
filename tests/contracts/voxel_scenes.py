"""Small scenes whose voxels are known."""

from __future__ import annotations

import numpy as np

import interreflect as ir

QUAD = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
UNIT_UV = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], np.float32)


def quad(corners, **material):
    """A quadrilateral, counter-clockwise seen from the front, texture coordinates from (0, 0) to (1, 1)."""
    return ir.Mesh(np.asarray(corners, np.float32), QUAD, texcoords=UNIT_UV, material=ir.Material(**material))


def floor(height=0.0, half=1.0, **material):
    """A square in the x-z plane that faces up."""
    return quad([[-half, height, half], [half, height, half], [half, height, -half], [-half, height, -half]], **material)


def box(lower=(-1, -1, -1), upper=(1, 1, 1), inward=False, **keys):
    """An axis-aligned box."""
    lo, hi = np.asarray(lower, float), np.asarray(upper, float)
    corners = np.array([[(lo, hi)[x][0], (lo, hi)[y][1], (lo, hi)[z][2]] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))], np.uint32)
    return ir.Mesh(corners, triangles[:, ::-1].copy() if inward else triangles, **keys)


def soup(seed, count=60):
    """Random triangles of all sizes in random colours."""
    random = np.random.default_rng(seed)
    centre = random.uniform(-1, 1, (count, 1, 3))
    corners = centre + random.normal(size=(count, 3, 3)) * 10 ** random.uniform(-2, -0.2, (count, 1, 1))
    return [
        ir.Mesh(c, np.array([[0, 1, 2]], np.uint32), material=ir.Material(albedo=tuple(random.uniform(0, 1, 3))))
        for c in corners.astype(np.float32)
    ]


def scene_of(*meshes, lights=(), **keys):
    return ir.Scene(meshes=list(meshes), lights=list(lights), **keys)


def mapped(scene, matrix):
    """The scene with every world mesh moved by a (4, 4) matrix, without lights."""
    return ir.Scene(meshes=[mesh.replace(transform=np.asarray(matrix, float) @ mesh.transform) for mesh in scene.meshes])


def scaled(factor, offset=(0, 0, 0)):
    matrix = np.diag([factor, factor, factor, 1.0])
    matrix[:3, 3] = offset
    return matrix
