"""Presets: papers' configurations as values of a method, nothing else."""

import pickle

import numpy as np
import pytest

import interreflect as ir

VCT = ir.methods.VoxelConeTracing


def test_presets_are_listed_by_name():
    assert VCT.presets == ("Freed 2018", "Rehfeld 2014 voxels")
    assert ir.methods.PathTracing.presets == ()


@pytest.mark.parametrize("name", VCT.presets)
def test_a_preset_is_a_value_like_any_other(name):
    method = VCT.preset(name)
    assert type(method) is VCT and method != VCT()
    assert pickle.loads(pickle.dumps(method)) == method == VCT.preset(name) == VCT().replace(VCT.preset_values[name])
    assert method.replace({"grid.resolution": 16}).knobs()["march.step"] == method.march.step


@pytest.mark.parametrize("name", VCT.presets)
def test_a_preset_renders(name):
    method = VCT.preset(name).replace({"grid.resolution": 32})
    if name == "Freed 2018":
        method = method.replace({"shadow.size": 256, "light_voxels.size": 256})
    frame = method.render(ir.scenes.cornell_box(box="glossy"), size=(48, 48))
    assert np.isfinite(frame.image).all() and frame.indirect.mean() > 0


def test_the_thesiss_preset_has_its_numbers():
    # Freed 2018: 256^3, 6 levels, 4096^2 shadow map, five cones, alpha .95, aperture 0.1 pi roughness.
    knobs = VCT.preset("Freed 2018").knobs()
    expected = {
        "grid.resolution": 256, "voxelize": "Tessellation", "light_voxels.size": 4096, "prefilter.levels": 6, "shadow.size": 4096,
        "shade": "FreedCookTorrance", "march.set": "freed_thesis", "march.cut_off": 0.05, "march.multiply_by_occlusion": True,
        "glossy.aperture": "freed",
    }  # fmt: skip
    assert {name: knobs[name] for name in expected} == expected


def test_an_unknown_preset_is_a_value_error_that_names_the_nearest():
    with pytest.raises(ValueError, match=r"VoxelConeTracing has no preset 'Fred 2018'; did you mean 'Freed 2018'\?"):
        VCT.preset("Fred 2018")
    with pytest.raises(ValueError, match="PathTracing has no preset 'x'; it has none"):
        ir.methods.PathTracing.preset("x")


def test_the_thesiss_tone_map_is_c_over_c_plus_1_with_gamma():
    from interreflect.images import tone_map

    picture = np.array([[[0, 1, 3]]], np.float32)
    expected = np.round(255 * np.array([0, 0.5, 0.75]) ** (1 / 2.2))
    assert tone_map(picture, curve="reinhard")[0, 0].tolist() == expected.tolist()
    with pytest.raises(ValueError, match="curve must be one of srgb, reinhard"):
        tone_map(picture, curve="film")
