"""The core takes arrays and checks every one: what is wrong is a ValueError that says what, before anything is read."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from interreflect import _core

P = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
T = np.array([[0, 1, 2]], np.uint32)
UV = np.zeros((3, 2), np.float32)
EYE, UPRIGHT = np.eye(4), np.eye(3)


def geometry(positions: Any = P, triangles: Any = T, normals: Any = None, texcoords: Any = None, number: int = 0, **placed: Any) -> Any:
    place = {"mesh": 0, "transform": EYE, "body": 0, **placed}
    return _core.Geometry([(positions, triangles, normals, texcoords, number)], [tuple(place.values())])


def scene(material: dict[str, Any] | None = None, lights: Any = (), environment: Any = None, masks: Any = (), **arrays: Any) -> Any:
    materials = [_core.Material(**(material or {}))]
    shape = geometry(**{"texcoords": UV, **arrays})
    return _core.Scene(shape, _core.Intersector(shape, materials, list(masks)), materials, [], [], list(lights), environment)


def environment(image: Any, rotation: Any = UPRIGHT) -> Any:
    return scene(environment=_core.Environment((1, 1, 1), image, rotation))


SKY = np.ones((2, 4, 3), np.float32)
MASK = _core.Mask(np.ones((2, 2), bool))


@pytest.mark.parametrize(
    ("message", "make"),
    [
        ("positions must have dtype float32", lambda: geometry(P.astype(float))),
        ("positions must have shape", lambda: geometry(P[:, :2].copy())),
        ("positions must be C-contiguous", lambda: geometry(np.zeros((3, 6), np.float32)[:, ::2])),
        ("positions must be a numpy array", lambda: geometry(P.tolist())),
        ("positions must be finite", lambda: geometry(P * np.nan)),
        ("triangles must have dtype uint32", lambda: geometry(P, T.astype(np.int64))),
        (r"triangles\[0\] has an index beyond", lambda: geometry(P, T + 1)),
        (r"triangles\[0\] has an index beyond", lambda: geometry(P, T + np.uint32(2**32 - 3))),
        ("normals must be as many", lambda: geometry(normals=P[:2].copy())),
        ("normals must be finite", lambda: geometry(normals=np.full_like(P, np.inf))),
        ("texcoords must be as many", lambda: geometry(texcoords=UV[:2].copy())),
        ("texcoords must be finite", lambda: geometry(texcoords=UV * np.nan)),
        (r"instances\[0\] names no mesh", lambda: geometry(mesh=1)),
        (r"transform must be finite", lambda: geometry(transform=EYE * np.nan)),
        (r"singular", lambda: geometry(transform=np.diag([1.0, 1, 0, 1]), body=1)),
        ("transform must have shape", lambda: geometry(transform=np.eye(3))),
        ("as many transforms as moving instances", lambda: geometry(body=1).moved([])),
        ("names a material that is not there", lambda: scene(number=5)),
        (r"albedo_map names no texture", lambda: scene({"albedo_map": 0})),
        (r"albedo_map names no texture", lambda: scene({"albedo_map": -7})),
        (r"emission_map names no texture", lambda: scene({"emission_map": 2**31 - 1})),
        (r"mask names no mask", lambda: scene({"mask": 0})),
        (r"mask names no mask", lambda: scene({"mask": 0}, masks=[MASK])),
        ("albedo must be finite", lambda: scene({"albedo": (np.nan, 0, 0)})),
        ("roughness must lie in", lambda: scene({"roughness": np.nan})),
        ("exponent must be finite", lambda: scene({"exponent": np.inf})),
        ("lobe must be one of", lambda: scene({"lobe": "ward"})),
        ("emission must be finite", lambda: scene({"emission": (-1, 0, 0)})),
        ("point light 0", lambda: scene(lights=[_core.PointLight((0, np.nan, 0), (1, 1, 1))])),
        ("spot light 0", lambda: scene(lights=[_core.SpotLight((0, 0, 0), (0, 1, 0), (1, 1, 1), 30, 20)])),
        ("directional light 0", lambda: scene(lights=[_core.DirectionalLight((0, 0, 0), (1, 1, 1))])),
        ("image must have shape", lambda: environment(SKY[:0].copy())),
        ("image must have dtype float32", lambda: environment(SKY.astype(float))),
        ("image must be finite", lambda: environment(SKY * np.nan)),
        ("rotation must be a rotation", lambda: environment(SKY, np.full((3, 3), np.nan))),
        ("rotation must be a rotation", lambda: environment(SKY, 2 * np.eye(3))),
        ("pixels must have shape", lambda: _core.Texture(np.zeros((2, 2), np.uint8))),
        ("channels", lambda: _core.Texture(np.zeros((2, 2, 2), np.uint8))),
        ("pixels", lambda: _core.Texture(np.zeros((0, 2, 3), np.uint8))),
        ("pixels must have dtype", lambda: _core.Texture(np.zeros((2, 2, 3), np.int32))),
        ("pixels must be finite", lambda: _core.Texture(np.full((2, 2, 3), np.nan, np.float32))),
        ("pixels must have dtype bool", lambda: _core.Mask(np.zeros((2, 2), np.uint8))),
        ("pixels", lambda: _core.Mask(np.zeros((0, 2), bool))),
        ("position not target", lambda: _core.Camera((0, 0, 0), (0, 0, 0), (0, 1, 0), 40)),
        ("up not parallel", lambda: _core.Camera((0, 3, 0), (0, 0, 0), (0, 1, 0), 40)),
        ("must be finite", lambda: _core.Camera((0, np.nan, 0), (0, 0, 0), (0, 1, 0), 40)),
        ("fov_x must lie in", lambda: _core.Camera((0, 0, 3), (0, 0, 0), (0, 1, 0), 180)),
        ("another geometry", lambda: another_geometry()),
    ],
)
def test_a_wrong_argument_of_the_core_is_a_value_error(message: str, make: Callable[[], Any]) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def another_geometry() -> Any:
    materials = [_core.Material()]
    return _core.Scene(geometry(), _core.Intersector(geometry(), materials, []), materials, [], [], [], None)


@pytest.mark.parametrize("size", [(0, 5), (5, -1), (10**6, 10**6)])
def test_a_picture_of_impossible_size_is_refused(size: tuple[int, int]) -> None:
    with pytest.raises(ValueError, match="width and height"):
        _core.trace_gbuffer(scene(), _core.Camera((0, 0, 3), (0, 0, 0), (0, 1, 0), 40), *size)


def test_scenes_without_triangles_are_black_pictures() -> None:
    empty = _core.Geometry([], [])
    materials = [_core.Material()]
    nothing = _core.Scene(empty, _core.Intersector(empty, materials, []), materials, [], [], [], None)
    for one in (nothing, scene(positions=P[:0].copy(), triangles=T[:0].copy(), texcoords=None)):
        gbuffer = _core.trace_gbuffer(one, _core.Camera((0, 0, 3), (0, 0, 0), (0, 1, 0), 40), 8, 4)
        assert not np.asarray(gbuffer.albedo).any() and np.asarray(gbuffer.albedo).shape == (4, 8, 3)
