"""The scenes that papers are reproduced on, each loaded once. FileNotFoundError says where a scene was looked for."""

from __future__ import annotations

from functools import cache

import interreflect as ir


@cache
def load(path: str) -> ir.Scene:
    return ir.load_scene(path)


def sponza() -> ir.Scene:
    """Freed's scene: the Crytek Sponza under a late-morning sun."""
    return load("sponza_crytek/scene.toml")


def sunny_sponza() -> ir.Scene:
    """Sponza without its sky: for what is about the voxels that a lamp hits."""
    scene = sponza()
    return scene.replace(lights=[light for light in scene.lights if not isinstance(light, ir.EnvironmentLight)])


def glossy_sponza() -> ir.Scene:
    """The same with a polished floor and the roughness of its maps: for what is about reflections (no normal maps)."""
    return load("sponza_crytek/glossy.toml")


def phong_sponza(exponent: float) -> ir.Scene:
    """Sponza with the same Phong lobe on every surface, as Rehfeld et al. have on theirs."""
    lobe = {"specular": (0.2, 0.2, 0.2), "lobe": "phong", "exponent": exponent}
    return sponza().replace(materials={"*": lobe})
