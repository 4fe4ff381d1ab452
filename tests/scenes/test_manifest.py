"""scene.toml: every key does what SCENE_FORMAT.md says, and everything else is refused."""

import os
from pathlib import Path

import numpy as np
import pytest
from scene_files import TRIANGLE, write, write_gltf, write_image

from interreflect.errors import SceneError
from interreflect.scenes.load import load_scene, read_scene
from interreflect.scenes.values import Camera, DirectionalLight, EnvironmentLight, PointLight, Scene, SpotLight

OBJ = "mtllib m.mtl\n" + TRIANGLE + "vt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 3/3 2/2 1/1\n"
MTL = "newmtl a\nKd 0.1 0.2 0.3\nKs 0.5 0.5 0.5\nNs 20\nnewmtl b\nKd 0.4 0.4 0.4\n"
GEOMETRY = '[[geometry]]\nfile = "a.obj"\n'


def load(folder: Path, text: str, **files: str | bytes) -> Scene:
    write(folder, scene_toml=text, **{"a_obj": OBJ, "m_mtl": MTL, **files})
    return read_scene(str(folder / "scene.toml"))


def test_names_units_cameras_and_lights_are_read(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        """
        name = "room"
        unit = 0.01
        up = [0, 0, 2]
        [camera.first]
        position = [0, -3, 0]
        target = [0, 0, 0]
        fov_x = 40
        size = [320, 200]
        [camera.second]
        position = [0, -3, 0]
        target = [0, 0, 0]
        up = [1, 0, 0]
        fov_x = 50
        [[light]]
        type = "directional"
        direction = [0, 0, -2]
        irradiance = [1, 2, 3]
        [[light]]
        type = "point"
        position = [1, 2, 3]
        intensity = [4, 5, 6]
        [[light]]
        type = "spot"
        position = [0, 0, 1]
        direction = [0, 0, -1]
        intensity = [1, 1, 1]
        inner = 20
        outer = 25
        [[light]]
        type = "environment"
        radiance = [0.5, 0.6, 0.7]
        """,
    )
    assert (scene.name, scene.unit, scene.up) == ("room", 0.01, (0, 0, 1))
    first = Camera(position=(0, -3, 0), target=(0, 0, 0), up=(0, 0, 2), fov_x=40, size=(320, 200))
    assert list(scene.cameras) == ["first", "second"] and scene.camera == first and scene.cameras["second"].up == (1, 0, 0)
    assert scene.lights == (
        DirectionalLight(direction=(0, 0, -1), irradiance=(1, 2, 3)),
        PointLight(position=(1, 2, 3), intensity=(4, 5, 6)),
        SpotLight(position=(0, 0, 1), direction=(0, 0, -1), intensity=(1, 1, 1), inner=20, outer=25),
        EnvironmentLight(radiance=(0.5, 0.6, 0.7)),
    )
    assert scene.triangles == 0


def test_material_tables_override_single_keys_star_first(tmp_path: Path) -> None:
    scene = load(
        tmp_path,
        GEOMETRY
        + """
        [material.a]
        roughness = 0.25
        [material."*"]
        specular = [0.1, 0.1, 0.1]
        roughness = 0.75
        two_sided = false
        """,
    )
    a, b = (mesh.material for mesh in scene.meshes)
    assert (a.name, a.albedo, a.specular, a.roughness, a.exponent) == ("a", (0.1, 0.2, 0.3), (0.1, 0.1, 0.1), 0.25, None)
    assert (b.name, b.albedo, b.roughness, b.two_sided) == ("b", (0.4, 0.4, 0.4), 0.75, False)


def test_a_geometrys_material_replaces_all_of_its_file(tmp_path: Path) -> None:
    paint = '[material.paint]\nalbedo = [1, 0, 0]\nlobe = "phong"\nexponent = 9\nspecular = [0, 0, 0.5]\n'
    text = GEOMETRY + 'material = "paint"\n' + paint
    materials = {mesh.material for mesh in load(tmp_path, text).meshes}
    assert len(materials) == 1
    (material,) = materials
    assert (material.albedo, material.lobe, material.exponent) == ((1, 0, 0), "phong", 9)


def test_transparent_triangles_are_not_loaded_but_count_as_used(tmp_path: Path) -> None:
    scene = load(tmp_path, GEOMETRY + "[material.b]\ntransparent = true\n")
    assert [mesh.material.name for mesh in scene.meshes] == ["a"]


def test_the_same_file_again_is_an_instance_stored_once(tmp_path: Path) -> None:
    moved = "transform = [0,-1,0,5, 1,0,0,0, 0,0,1,0, 0,0,0,1]\n"
    scene = load(tmp_path, GEOMETRY + GEOMETRY + moved + 'body = "car"\n')
    assert scene.triangles == 4 and [mesh.body for mesh in scene.meshes] == ["world", "world", "car", "car"]
    assert scene.meshes[0].positions is scene.meshes[2].positions
    assert np.array_equal(scene.meshes[2].transform, [[0, -1, 0, 5], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    assert list(scene.bodies) == ["world", "car"]
    assert np.array_equal(scene.bounds, [[0, 0, 0], [5, 1, 0]])


def test_normals_are_the_files_flat_or_smooth(tmp_path: Path) -> None:
    # a square folded by 90 degrees along its diagonal (1,0,0)-(0,1,0), in two materials; the file's normals point along x
    obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nusemtl b\nf 3//1 2//1 4//1\n"
    for mode, expected in (("file", [1, 0, 0]), ("flat", None)):
        scene = load(tmp_path, GEOMETRY + f'normals = "{mode}"\n[material.b]\n', a_obj=obj)
        for mesh in scene.meshes:
            assert mesh.normals is None if expected is None else np.array_equal(mesh.normals, [expected] * 3)
    scene = load(tmp_path, GEOMETRY + 'normals = "smooth"\n[material.b]\n', a_obj=obj)
    faces = []
    for mesh in scene.meshes:
        a, b, c = mesh.positions[mesh.triangles[0]].astype(float)
        normal = np.cross(b - a, c - a)
        faces.append(normal / np.linalg.norm(normal))
    at = {tuple(p): n for mesh in scene.meshes for p, n in zip(mesh.positions.tolist(), mesh.normals, strict=True)}
    first, second = np.array([0, 0, 0.0]), np.array([1, 0, 1.0])
    assert np.allclose(at[tuple(first)], faces[0], atol=1e-6) and np.allclose(at[tuple(second)], faces[1], atol=1e-6)

    def angle(p: np.ndarray, q: np.ndarray, r: np.ndarray) -> float:
        return float(np.arccos((q - p) @ (r - p) / np.linalg.norm(q - p) / np.linalg.norm(r - p)))

    for p, other in (((1.0, 0, 0), (0.0, 1, 0)), ((0.0, 1, 0), (1.0, 0, 0))):
        p_, o = np.array(p), np.array(other)
        weighted = angle(p_, first, o) * faces[0] + angle(p_, second, o) * faces[1]
        assert np.allclose(at[p], weighted / np.linalg.norm(weighted), atol=1e-6)


def test_textures_and_masks_are_read_as_stored(tmp_path: Path) -> None:
    tmp_path.mkdir(exist_ok=True)
    colours = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3) * 10
    write_image(tmp_path / "t.png", colours)
    write_image(tmp_path / "t.exr", colours.astype(np.float32) / 7)
    write_image(tmp_path / "deep.png", colours.astype(np.uint16) * 257)
    write_image(tmp_path / "grey.png", np.array([[[127], [128]]], np.uint8))
    write_image(tmp_path / "alpha.png", np.array([[[255, 0, 0, 127], [0, 0, 0, 128]]], np.uint8))
    text = GEOMETRY + '[material.a]\nalbedo_map = "{}"\nemission_map = "t.exr"\nemission = [1, 1, 1]\nmask = "{}"\n'
    for image, mask in (("t.png", "grey.png"), ("deep.png", "alpha.png"), ("t.exr", "grey.png")):
        material = load(tmp_path, text.format(image, mask)).meshes[0].material
        assert material.albedo == (0.1, 0.2, 0.3) and material.albedo_map is not None and material.mask is not None
        pixels = material.albedo_map.pixels
        if image == "t.png":
            assert pixels.dtype == np.uint8 and np.array_equal(pixels, colours)
        elif image == "t.exr":
            assert np.allclose(pixels, colours.astype(np.float32) / 7, rtol=1e-3)  # half floats
        else:
            srgb = colours / 255
            linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
            assert pixels.dtype == np.float32 and np.allclose(pixels, linear, atol=1e-6)
        assert material.mask.solid.tolist() == [[False, True]]


def test_a_map_makes_albedo_one_by_default(tmp_path: Path) -> None:
    write_image(tmp_path / "t.png", np.zeros((1, 1, 3), np.uint8))
    text = '[[geometry]]\nfile = "a.obj"\nmaterial = "x"\n[material.x]\nalbedo_map = "t.png"\n'
    assert load(tmp_path, text).meshes[0].material.albedo == (1, 1, 1)


def test_an_environment_image_may_lie_beside_the_scenes_folder(tmp_path: Path) -> None:
    (tmp_path / "envmaps").mkdir()
    write_image(tmp_path / "envmaps" / "sky.exr", np.full((2, 4, 3), 0.25, np.float32))
    text = '[[light]]\ntype = "environment"\nfile = "../envmaps/sky.exr"\nradiance = [2, 2, 2]\nrotation = 30\n'
    (light,) = load(tmp_path / "room", text).lights
    assert isinstance(light, EnvironmentLight) and light.rotation == 30 and light.radiance == (2, 2, 2)
    assert light.image is not None and light.image.shape == (2, 4, 3) and (light.image == 0.25).all()


def test_lights_and_cameras_of_a_gltf_come_after_the_manifests_and_move_with_it(tmp_path: Path) -> None:
    write_gltf(
        tmp_path,
        nodes=[{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}, "camera": 0, "name": "own"}],
        cameras=[{"type": "perspective", "perspective": {"yfov": 1}}],
        extensions={"KHR_lights_punctual": {"lights": [{"type": "point"}]}},
    )
    text = '[[geometry]]\nfile = "square.gltf"\ntransform = [1,0,0,7, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n'
    scene = load(
        tmp_path,
        text + '[camera.mine]\nposition = [0,0,1]\ntarget = [0,0,0]\nfov_x = 30\n[[light]]\ntype = "environment"\nradiance = [1,1,1]\n',
    )
    assert list(scene.cameras) == ["mine", "own"] and scene.cameras["own"].position == (7, 0, 0)
    assert isinstance(scene.lights[0], EnvironmentLight) and scene.lights[1] == PointLight(position=(7, 0, 0), intensity=(1, 1, 1))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('name = "x"\ncolour = 1', "'colour' is no known key"),
        ("unnit = 1", "'unnit' is no known key; did you mean 'unit'"),
        ("name = 3", "name must be a string, got 3"),
        ("unit = 0", "unit must be a finite number above 0, got 0"),
        ("unit = nan", "unit must be"),
        ("up = [0, 0, 0]", "up must not have zero length"),
        ('up = "y"', "up must be three finite numbers, got 'y'"),
        ('name = "x', "is no TOML"),
        ("a = [" + "[" * 5000, "is no TOML|more than"),
        (".".join("a" * 50_000) + " = 1", "a key of more than 16 parts is not read"),
        ("'b' . " + " . ".join(['"a"'] * 20) + " = 1", "a key of more than 16 parts is not read"),
        ("geometry = 3", r"geometry must be a list of tables"),
        ("[geometry]\nfile = 'a.obj'", r"geometry must be a list of tables"),
        ("material = 1", "material must hold tables"),
        ("[material]\nred = 1", "material must hold tables"),
        ("[[geometry]]", r"geometry\[0\].file is missing"),
        ("[[geometry]]\nfile = 3", r"geometry\[0\].file must be a file name, got 3"),
        ("[[geometry]]\nfile = 'absent.obj'", r"geometry\[0\].file 'absent.obj' does not exist"),
        ("[[geometry]]\nfile = '.'", r"geometry\[0\].file '.' does not exist"),
        ("[[geometry]]\nfile = 'm.mtl'", r"m.mtl: must be one of .obj, .ply, .gltf, .glb"),
        ("[[geometry]]\nfile = '/etc/hostname'", "must be a relative path without a scheme"),
        ("[[geometry]]\nfile = 'http://example.org/a.obj'", "must be a relative path without a scheme"),
        ("[[geometry]]\nfile = 'C:a.obj'", "must be a relative path without a scheme"),
        ("[[geometry]]\nfile = '../../a.obj'", "must not lead above"),
        ('[[geometry]]\nfile = "a\\u0000.obj"', "must be a relative path"),
        (GEOMETRY + "normal = 'flat'", r"geometry\[0\].'normal' is no known key; did you mean 'normals'"),
        (GEOMETRY + "normals = 'round'", r"geometry\[0\].normals must be one of 'file', 'flat', 'smooth', got 'round'"),
        (GEOMETRY + "body = ''", r"geometry\[0\].body must be a name"),
        (GEOMETRY + "transform = [1, 0]", r"geometry\[0\].transform must be 16 numbers"),
        (
            GEOMETRY + "transform = [1,0,0,0, 0,1,0,0, 0,0,1,inf, 0,0,0,1]",
            r"geometry\[0\].transform\[11\] must be a finite number, got inf",
        ),
        (GEOMETRY + "transform = [1,0,0,0, 0,1,0,0, 0,0,0,0, 0,0,0,1]", r"geometry\[0\].transform must be invertible"),
        (GEOMETRY + "transform = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,1,1]", r"geometry\[0\].transform must end in the row 0, 0, 0, 1"),
        (GEOMETRY + "material = 'c'", r"geometry\[0\].material 'c' is not defined"),
        (GEOMETRY + "[material.c]", "material.c is used by no geometry"),
        (GEOMETRY + "[material.a]\nalbdo = [1, 1, 1]", r"material.a.'albdo' is no known key; did you mean 'albedo'"),
        (GEOMETRY + "[material.a]\nalbedo = [1, 1]", r"material.a.albedo must be three finite numbers, got \[1, 1\]"),
        (GEOMETRY + "[material.a]\nalbedo = [1, 1, 2]", r"material.a.albedo must be three numbers in \[0, 1\], got \[1, 1, 2\]"),
        (GEOMETRY + "[material.a]\nalbedo = [1, 1, true]", "material.a.albedo must be three finite numbers"),
        (GEOMETRY + "[material.a]\nroughness = 0.1\nexponent = 3", "material.a must have only one of roughness and exponent"),
        (GEOMETRY + "[material.a]\nexponent = -1", "material.a.exponent must be a finite number above 0, got -1"),
        (GEOMETRY + "[material.b]\nlobe = 'phong'", "material.b.lobe 'phong' must have an exponent"),
        (GEOMETRY + "[material.a]\nlobe = 'pong'", "material.a.lobe must be one of 'ggx', 'phong', 'blinn-phong', got 'pong'"),
        (GEOMETRY + "[material.a]\ntwo_sided = 1", "material.a.two_sided must be true or false, got 1"),
        (GEOMETRY + "[material.a]\ntransparent = 'no'", "material.a.transparent must be true or false"),
        (GEOMETRY + "[material.a]\nalbedo_map = 'absent.png'", "material.a.albedo_map 'absent.png' does not exist"),
        (GEOMETRY + "[material.a]\nmask = 3", "material.a.mask must be a file name"),
        (GEOMETRY + "[material.a]\nemission_map = 'a.obj'", "a.obj: is no image that can be read"),
        ("[camera.a]\nposition = [0,0,0]\ntarget = [0,0,0]\nfov_x = 40", "camera.a.target must differ from position"),
        ("[camera.a]\nposition = [0,0,3]\ntarget = [0,0,0]\nfov_x = 190", r"camera.a.fov_x must lie in \(0, 180\) degrees, got 190"),
        ("[camera.a]\nposition = [0,0,3]\ntarget = [0,0,0]", "camera.a.fov_x is missing"),
        ("[camera.a]\nposition = [0,0,3]\ntarget = [0,0,0]\nfov_x = 40\nfov = 3", "camera.a.'fov' is no known key; did you mean 'fov_x'"),
        ("[camera.a]\nposition = [0,3,0]\ntarget = [0,0,0]\nfov_x = 40", "camera.a.up must not be parallel"),
        ("[camera.a]\nposition = [0,0,3]\ntarget = [0,0,0]\nfov_x = 40\nsize = [0, 3]", "camera.a.size must be"),
        ("[[light]]", r"light\[0\].type must be one of"),
        ("[[light]]\ntype = 'sun'", r"light\[0\].type must be one of 'directional', 'point', 'spot', 'environment', got 'sun'"),
        ("[[light]]\ntype = 'point'\nposition = [0,0,0]", r"light\[0\].intensity is missing"),
        (
            "[[light]]\ntype='environment'\nradiance=[1,1,1]\n[[light]]\ntype = 'point'\nposition = [0,0,0]\nintensity = [1.0,nan,1.0]",
            r"side/scene.toml: light\[1\].intensity must be three finite numbers, got \[1.0, nan, 1.0\]$",
        ),
        (
            "[[light]]\ntype = 'point'\nposition = [0,0,0]\nintensity = [1,-1,1]",
            r"light\[0\].intensity must be three numbers of at least 0",
        ),
        ("[[light]]\ntype = 'point'\nposition = [0,0,0]\nintensity = [1,1,1]\nradiance = 1", r"light\[0\].'radiance' is no known key"),
        ("[[light]]\ntype = 'environment'", r"light\[0\].radiance is missing"),
        ("[[light]]\ntype = 'environment'\nfile = 'absent.exr'", r"light\[0\].file 'absent.exr' does not exist"),
        (
            "[[light]]\ntype='environment'\nradiance=[1,1,1]\n[[light]]\ntype='environment'\nradiance=[1,1,1]",
            "at most one EnvironmentLight",
        ),
    ],
)
def test_what_is_malformed_is_refused_with_file_and_key(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(SceneError, match=message) as error:
        load(tmp_path / "in" / "side", text)
    assert str(error.value).startswith("side/")


def test_a_link_that_leads_out_is_refused(tmp_path: Path) -> None:
    outside = write(tmp_path / "outside", a_obj=TRIANGLE + "f 1 2 3\n")
    inside = tmp_path / "all" / "scenes"
    inside.mkdir(parents=True)
    os.symlink(outside / "a.obj", inside / "b.obj")
    os.symlink(outside, inside / "folder")
    for name in ("b.obj", "folder/a.obj"):
        with pytest.raises(SceneError, match="must not lead above"):
            load(inside, f'[[geometry]]\nfile = "{name}"\n')


def test_a_texture_with_too_many_pixels_is_refused_before_it_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_image(tmp_path / "t.png", np.zeros((8, 9, 3), np.uint8))
    text = GEOMETRY + "[material.a]\nalbedo_map = 't.png'\nmask = 't.png'\n"
    monkeypatch.setattr("interreflect.scenes.files.MAX_SCENE_PIXELS", 143)
    with pytest.raises(SceneError, match=r"t.png: the scene's images have more than the 143 pixels that are read"):
        load(tmp_path, text)
    monkeypatch.setattr("interreflect.scenes.files.MAX_PIXELS", 71)
    with pytest.raises(SceneError, match=r"t.png: 72 pixels are more than the 71 that are read"):
        load(tmp_path, text)


def test_pixels_that_are_not_finite_are_refused_and_negative_ones_raised_with_a_warning(tmp_path: Path) -> None:
    text = '[[light]]\ntype = "environment"\nfile = "sky.exr"\n'
    for value in (np.nan, np.inf):
        write_image(tmp_path / "sky.exr", np.full((2, 4, 3), value, np.float32))
        with pytest.raises(SceneError, match=r"sky.exr: holds numbers that are not finite"):
            load(tmp_path, text)
    pixels = np.ones((2, 4, 3), np.float32)
    pixels[0, 1, 2] = -0.5
    write_image(tmp_path / "sky.exr", pixels)
    scene = load(tmp_path, text)
    assert "sky.exr: 1 pixels below 0 raised to 0" in scene.warnings[0]
    assert isinstance(scene.lights[0], EnvironmentLight) and scene.lights[0].image is not None and scene.lights[0].image.min() == 0


def test_a_file_over_the_size_cap_is_refused_before_it_is_read(tmp_path: Path) -> None:
    write(tmp_path, a_obj="")
    with open(tmp_path / "a.obj", "r+b") as file:
        file.truncate(2**30 + 1)  # sparse: takes no room
    with pytest.raises(SceneError, match=r"a.obj: 1073741825 bytes are more than"):
        load_scene(tmp_path / "a.obj")


def test_scenes_are_looked_for_as_given_then_in_the_named_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    load(tmp_path / "scenes" / "room", 'name = "there"')
    monkeypatch.setenv("INTERREFLECT_SCENES", str(tmp_path / "scenes"))
    assert load_scene("room/scene.toml").name == "there"
    load(tmp_path / "here" / "room", 'name = "here"')
    monkeypatch.chdir(tmp_path / "here")
    assert load_scene("room/scene.toml").name == "here"
    assert load_scene(tmp_path / "scenes" / "room" / "scene.toml").name == "there"
    with pytest.raises(FileNotFoundError, match=r"no scene 'absent.toml'; tried .*here/absent.toml, .*scenes/absent.toml"):
        load_scene("absent.toml")


def test_a_file_of_unknown_kind_is_refused(tmp_path: Path) -> None:
    write(tmp_path, a_stl="solid")
    with pytest.raises(SceneError, match=r"a.stl: must be one of .toml, .obj, .ply, .gltf, .glb, got '.stl'"):
        load_scene(tmp_path / "a.stl")
