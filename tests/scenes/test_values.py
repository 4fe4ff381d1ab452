"""Scene values: checked when made, equal by content, shared when derived."""

import pickle

import numpy as np
import pytest

from interreflect.scenes.values import (
    Camera,
    DirectionalLight,
    EnvironmentLight,
    Mask,
    Material,
    Mesh,
    PointLight,
    Scene,
    SpotLight,
    Texture,
)

POSITIONS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
TRIANGLES = np.array([[0, 1, 2]], np.uint32)


def turned(degrees: float, shift: tuple[float, float, float] = (0, 0, 0)) -> np.ndarray:
    """A rotation about y and a translation."""
    a = np.radians(degrees)
    pose = np.eye(4)
    pose[:3, :3] = [[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]]
    pose[:3, 3] = shift
    return pose


def car_scene() -> Scene:
    texture = Texture(np.full((2, 2, 3), 200, np.uint8))
    car = Mesh(POSITIONS, TRIANGLES, material=Material(name="paint", albedo_map=texture), body="car")
    floor = Mesh(POSITIONS * 2, TRIANGLES, material=Material(name="floor"))
    lights = [PointLight(position=(0, 1, 0), intensity=(1, 1, 1)), DirectionalLight(direction=(0, -2, 0), irradiance=(1, 2, 3))]
    return Scene(meshes=[car, floor], lights=lights, cameras={"front": Camera(position=(0, 0, 3), target=(0, 0, 0), fov_x=40)})


def test_arrays_are_kept_read_only_and_apart_from_what_was_given() -> None:
    given = POSITIONS.copy()
    mesh = Mesh(given, TRIANGLES)
    given[0, 0] = 7
    assert mesh.positions[0, 0] == 0
    assert mesh.positions.dtype == np.float32 and mesh.triangles.dtype == np.uint32
    with pytest.raises(ValueError, match="read-only"):
        mesh.positions[0, 0] = 1


def test_non_contiguous_arrays_are_copied() -> None:
    wide = np.zeros((3, 6), np.float64)
    wide[:, ::2] = POSITIONS
    mesh = Mesh(wide[:, ::2], np.array([[2, 1, 0]])[:, ::-1])
    assert mesh.positions.flags.c_contiguous and mesh.triangles.flags.c_contiguous
    assert np.array_equal(mesh.positions, POSITIONS) and np.array_equal(mesh.triangles, TRIANGLES)


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("positions", {"positions": np.zeros((3, 2))}),
        ("positions", {"positions": np.zeros(9)}),
        ("positions", {"positions": np.full((3, 3), np.nan)}),
        ("positions", {"positions": np.full((3, 3), np.inf)}),
        ("positions", {"positions": np.full((3, 3), 1e39)}),  # beyond float32
        ("positions", {"positions": np.zeros((3, 3), complex)}),
        ("positions", {"positions": [["a", "b", "c"]]}),
        ("positions", {"positions": [[0, 0, 0], [1, 0]]}),
        ("triangles", {"triangles": [[0, 1, 3]]}),
        ("triangles", {"triangles": [[0, 1, -1]]}),
        ("triangles", {"triangles": [[0.0, 1.0, 2.0]]}),
        ("triangles", {"triangles": [[0, 1, 2, 0]]}),
        ("triangles", {"triangles": np.broadcast_to(np.uint32(0), (2**31, 3))}),  # more than 2^32 indices, none of them stored
        ("normals", {"normals": np.zeros((3, 3))}),
        ("normals", {"normals": np.ones((2, 3))}),
        ("texcoords", {"texcoords": np.zeros((3, 3))}),
        ("texcoords", {"texcoords": np.full((3, 2), np.nan)}),
        ("material", {"material": "red"}),
        ("body", {"body": ""}),
        ("transform", {"transform": np.zeros((4, 4))}),
        ("transform", {"transform": np.eye(3)}),
        ("transform", {"transform": np.full((4, 4), np.nan)}),
    ],
)
def test_a_wrong_array_is_a_value_error_that_names_the_argument(name: str, arguments: dict) -> None:
    with pytest.raises(ValueError, match=rf"^{name}\b"):
        Mesh(**{"positions": POSITIONS, "triangles": TRIANGLES, **arguments})


@pytest.mark.parametrize(
    ("name", "make"),
    [
        ("albedo", lambda: Material(albedo=(0.5, 0.5, 1.5))),
        ("albedo", lambda: Material(albedo=(0.5, 0.5))),
        ("specular", lambda: Material(specular=(0, 0, float("nan")))),
        ("roughness", lambda: Material(roughness=-0.1)),
        ("exponent", lambda: Material(exponent=0)),
        ("only one of roughness and exponent", lambda: Material(exponent=5, roughness=0.5)),
        ("lobe", lambda: Material(lobe="ward")),
        ("lobe 'phong' must have an exponent", lambda: Material(lobe="phong")),
        ("emission", lambda: Material(emission=(-1, 0, 0))),
        ("albedo_map", lambda: Material(albedo_map="wood.png")),
        ("mask", lambda: Material(mask=Texture(np.zeros((1, 1, 3), np.uint8)))),
        ("two_sided", lambda: Material(two_sided="yes")),
        ("pixels", lambda: Texture(np.zeros((2, 2, 3), np.int32))),
        ("pixels", lambda: Texture(np.zeros((2, 2, 4), np.uint8))),
        ("pixels", lambda: Texture(np.zeros((0, 2, 3), np.uint8))),
        ("pixels", lambda: Texture(np.full((2, 2, 3), -1.0))),
        ("pixels", lambda: Texture(np.full((2, 2, 3), np.nan))),
        ("pixels", lambda: Texture(np.broadcast_to(np.uint8(0), (2**14, 2**14, 3)))),
        ("solid", lambda: Mask(np.zeros((2, 2)))),
        ("position", lambda: PointLight(position=(0, float("inf"), 0), intensity=(1, 1, 1))),
        ("intensity", lambda: PointLight(position=(0, 0, 0), intensity=(1, float("nan"), 1))),
        ("direction", lambda: DirectionalLight(direction=(0, 0, 0), irradiance=(1, 1, 1))),
        ("inner", lambda: SpotLight(position=(0, 0, 0), direction=(0, 1, 0), intensity=(1, 1, 1), inner=30, outer=20)),
        ("outer", lambda: SpotLight(position=(0, 0, 0), direction=(0, 1, 0), intensity=(1, 1, 1), inner=0, outer=0)),
        ("image", lambda: EnvironmentLight(image=np.zeros((2, 4), np.float32))),
        ("target", lambda: Camera(position=(0, 0, 0), target=(0, 0, 0), fov_x=40)),
        ("fov_x", lambda: Camera(position=(0, 0, 3), target=(0, 0, 0), fov_x=190)),
        ("up", lambda: Camera(position=(0, 3, 0), target=(0, 0, 0), fov_x=40)),
        ("size", lambda: Camera(position=(0, 0, 3), target=(0, 0, 0), fov_x=40, size=(0, 10))),
        ("lights", lambda: Scene(lights=[EnvironmentLight(), EnvironmentLight()])),
        (r"meshes\[0\]", lambda: Scene(meshes=["cube"])),
        (r"cameras\['a'\]", lambda: Scene(cameras={"a": None})),
        (r"bodies\['cat'\]", lambda: car_scene().replace(bodies={"cat": np.eye(4)})),
        (r"bodies\['car'\] must be rigid", lambda: car_scene().replace(bodies={"car": np.diag([2, 2, 2, 1])})),
        (r"bodies\['car'\] must be rigid", lambda: car_scene().replace(bodies={"car": np.diag([-1, 1, 1, 1])})),
        (r"bodies\['world'\]", lambda: car_scene().replace(bodies={"world": turned(3)})),
        (r"materials\['pant'\].*did you mean 'paint'", lambda: car_scene().replace(materials={"pant": {"roughness": 1}})),
        ("albedo", lambda: car_scene().replace(materials={"*": {"albedo": (2, 0, 0)}})),
        ("body", lambda: car_scene().instance("cat", [np.eye(4)])),
        (r"transforms\[1\] must be rigid", lambda: car_scene().instance("car", [np.eye(4), np.diag([2, 2, 2, 1])])),
    ],
)
def test_a_wrong_argument_is_a_value_error_that_names_it(name: str, make) -> None:
    with pytest.raises(ValueError, match=rf"^{name}"):
        make()


def test_an_unknown_material_key_is_a_type_error_with_the_nearest_name() -> None:
    with pytest.raises(TypeError, match="no key 'roughnes'; did you mean 'roughness'"):
        car_scene().replace(materials={"*": {"roughnes": 1}})


def test_albedo_defaults_to_a_half_and_with_a_map_to_one() -> None:
    assert Material().albedo == (0.5, 0.5, 0.5)
    assert Material(albedo_map=Texture(np.zeros((1, 1, 3), np.uint8))).albedo == (1, 1, 1)


def test_an_exponent_and_a_roughness_replace_each_other() -> None:
    phong = Material().replace(lobe="phong", exponent=50)
    assert (phong.exponent, phong.roughness) == (50, None)
    assert (phong.replace(roughness=0.1).exponent, phong.replace(roughness=0.1).lobe) == (None, "ggx")


def test_scenes_of_equal_content_are_equal_and_cameras_do_not_count() -> None:
    scene = car_scene()
    assert scene == car_scene() and hash(scene) == hash(car_scene())
    assert scene.replace(cameras={}).hash == scene.hash
    changed = [
        scene.replace(lights=scene.lights[:1]),
        scene.replace(lights=scene.lights[::-1]),
        scene.replace(bodies={"car": turned(0, (1, 0, 0))}),
        scene.replace(materials={"paint": {"roughness": 0.1}}),
        scene.instance("car", [turned(5)]),
        Scene(meshes=scene.meshes[:1], lights=scene.lights),
    ]
    assert len({scene.hash, *(other.hash for other in changed)}) == len(changed) + 1


def test_deriving_a_scene_changes_nothing_in_place_and_shares_arrays() -> None:
    scene = car_scene()
    before = scene.hash
    glossy = scene.replace(materials={"*": {"specular": (0.2, 0.2, 0.2), "lobe": "phong", "exponent": 50}}, lights=())
    assert scene.hash == before and scene.lights and scene.meshes[0].material.lobe == "ggx"
    assert glossy.meshes[0].material.exponent == 50 and glossy.meshes[1].material.exponent == 50
    assert glossy.meshes[0].positions is scene.meshes[0].positions


def test_star_comes_before_the_named_material() -> None:
    scene = car_scene().replace(materials={"paint": {"roughness": 0.2}, "*": {"roughness": 0.7}})
    assert [mesh.material.roughness for mesh in scene.meshes] == [0.2, 0.7]


def test_instances_are_bodies_of_their_own_and_share_their_arrays() -> None:
    scene = car_scene()
    cars = scene.instance("car", [turned(90, (3, 0, 0)), turned(0, (0, 0, 9))])
    assert list(cars.bodies) == ["world", "car", "car.1", "car.2"]
    assert cars.triangles == scene.triangles + 2
    assert all(mesh.positions is scene.meshes[0].positions for mesh in cars.meshes if mesh.body.startswith("car"))
    assert np.allclose(cars.bounds[1], [3, 2, 9])  # floor to y = 2; the turned car begins at x = 3; the second one lies at z = 9
    more = cars.instance("car", [turned(1)])
    assert list(more.bodies)[-1] == "car.3"


def test_bounds_follow_the_triangles_not_unused_positions() -> None:
    positions = np.concatenate([POSITIONS, [[100, 100, 100]]])
    assert np.array_equal(Scene(meshes=[Mesh(positions, TRIANGLES)]).bounds, [[0, 0, 0], [1, 1, 0]])


def test_an_empty_scene_is_a_scene() -> None:
    scene = Scene()
    assert scene.triangles == 0 and scene.bounds.shape == (2, 3) and scene.hash and not scene.lights
    with pytest.raises(ValueError, match="has no camera"):
        _ = scene.camera


def test_pickling_keeps_content_and_locks() -> None:
    scene = car_scene().replace(bodies={"car": turned(20)})
    copy = pickle.loads(pickle.dumps(scene))
    assert copy == scene and list(copy.cameras) == ["front"] and np.array_equal(copy.bodies["car"], scene.bodies["car"])
    assert not copy.meshes[0].positions.flags.writeable


def test_normals_become_unit_length() -> None:
    mesh = Mesh(POSITIONS, TRIANGLES, normals=[[0, 0, 5]] * 3)
    assert np.allclose(mesh.normals, [[0, 0, 1]] * 3)
