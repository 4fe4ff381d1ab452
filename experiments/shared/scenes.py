"""The scenes that papers are reproduced on, each loaded once. FileNotFoundError says where a scene was looked for."""

from __future__ import annotations

from functools import cache

import interreflect as ir
from interreflect.scenes.files import Folder
from interreflect.scenes.images import read_radiance
from interreflect.scenes.load import find


@cache
def load(path: str) -> ir.Scene:
    return ir.load_scene(path)


def sponza() -> ir.Scene:
    """Freed's scene: the Crytek Sponza under a late-morning sun."""
    return load("sponza_crytek/scene.toml")


def sponza_by_a_spot() -> ir.Scene:
    """Sponza without sun and sky: a spot from under the roof across the nave, on the floor and the arcade that its camera sees."""
    spot = ir.SpotLight(position=(-700, 800, 100), direction=(0.75, -0.6, -0.3), intensity=(4e6, 3.6e6, 3e6), inner=32, outer=40)
    return sponza().replace(lights=[spot], name="Sponza by a spot")


def sunny_sponza() -> ir.Scene:
    """Sponza without its sky: for what is about the voxels that a lamp hits."""
    return without_sky(sponza())


def without_sky(scene: ir.Scene) -> ir.Scene:
    return scene.replace(lights=[light for light in scene.lights if not isinstance(light, ir.EnvironmentLight)])


def sunny_phong_sponza() -> ir.Scene:
    """Sponza with the Phong lobe of Jendersie et al. on every surface, in the sun alone."""
    return without_sky(load("sponza_crytek/phong30.toml"))


def sunny_sibenik() -> ir.Scene:
    """The cathedral of Sibenik by its sun and candles."""
    return without_sky(load("sibenik/scene.toml"))


def phong_sibenik() -> ir.Scene:
    """The same with the Phong lobe of Jendersie et al. on every surface."""
    return sunny_sibenik().replace(materials={"*": {"specular": (0.2, 0.2, 0.2), "lobe": "phong", "exponent": 30.0}})


def glossy_sponza() -> ir.Scene:
    """The same with a polished floor and the roughness of its maps: for what is about reflections (no normal maps)."""
    return load("sponza_crytek/glossy.toml")


def phong_sponza(exponent: float) -> ir.Scene:
    """Sponza with the same Phong lobe on every surface, as Rehfeld et al. have on theirs."""
    lobe = {"specular": (0.2, 0.2, 0.2), "lobe": "phong", "exponent": exponent}
    return sponza().replace(materials={"*": lobe})


def car_in_a_hall() -> ir.Scene:
    """A car, a body of its own, on its ground under the environment of a hall."""
    scene, path = load("bmw_m6/scene.toml"), find("envmaps/interior.exr")
    hall = ir.EnvironmentLight(image=read_radiance(path, Folder.of(path)))
    return scene.replace(lights=[hall], name="car in a hall")
