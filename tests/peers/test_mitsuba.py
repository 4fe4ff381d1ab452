"""Mitsuba 3 as an independent witness: the same light in the same places."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import interreflect as ir

pytest.importorskip("mitsuba", reason="the extra `peers` is not installed")

import mitsuba_scene as witness
from welch import compare

SPONZA = Path(os.environ.get("INTERREFLECT_SCENES", "../shared/scenes")) / "sponza_crytek" / "scene.toml"


def assert_same(scene: ir.Scene, size: tuple[int, int], bounces: int | None, spp: int, renderings: int = 6) -> None:
    camera = scene.camera
    theirs_scene = witness.to_mitsuba(scene, camera, size)
    theirs = np.stack([witness.render(theirs_scene, bounces, spp, seed) for seed in range(renderings)])
    method = ir.methods.PathTracing(spp=spp, bounces=bounces, pixel="box").prepare(scene)
    ours = np.stack([method.render(camera, size=size, seed=seed).image for seed in range(renderings)])
    found = compare(theirs, ours)
    # A true null has 1e-3 of its tests below 1e-3; edges that fall between two float roundings add a few tiles.
    assert found.share_below(1e-3) < 0.02
    # Five standard errors, and the tenth of a per cent by which self-intersection offsets and roulette may differ.
    assert abs(found.mean_difference) < 5 * found.mean_error + 1e-3


@pytest.mark.parametrize("bounces", [0, 1, None])
def test_cornell_box_agrees_with_mitsuba(bounces: int | None) -> None:
    assert_same(witness.diffuse(ir.scenes.cornell_box()), (64, 64), bounces, spp=64)


LOBES = {
    "ggx": {"roughness": 0.4},  # alpha .16
    "rough ggx": {"roughness": 0.9},
    "phong": {"lobe": "phong", "exponent": 20.0},
    "blinn-phong": {"lobe": "blinn-phong", "exponent": 40.0},
}


@pytest.mark.parametrize("bounces", [0, 2])
@pytest.mark.parametrize("lobe", LOBES)
def test_glossy_surfaces_agree_with_mitsuba(lobe: str, bounces: int) -> None:
    surface = {"albedo": (0.3, 0.25, 0.2), "specular": (0.4, 0.5, 0.6), **LOBES[lobe]}
    scene = witness.diffuse(ir.scenes.cornell_box()).replace(materials={"white": surface, "tall block": surface})
    assert_same(scene, (64, 64), bounces, spp=64)


@pytest.mark.long
@pytest.mark.parametrize("bounces", [1, None])
def test_atrium_agrees_with_mitsuba(bounces: int | None) -> None:
    assert_same(witness.diffuse(ir.scenes.atrium()), (96, 64), bounces, spp=128)


@pytest.mark.long
@pytest.mark.skipif(not SPONZA.exists(), reason="the Sponza scene is not on this machine")
def test_sponza_agrees_with_mitsuba() -> None:
    assert_same(witness.diffuse(ir.load_scene(SPONZA)), (96, 54), 1, spp=128)
