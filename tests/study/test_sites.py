"""Rehfeld's figures are made at two sites, alike in lobes and light; records find back to the site they were made at."""

import numpy as np
import pandas as pd
import pytest
from experiments.rehfeld import figure_7, sites
from experiments.shared import two_cars

import interreflect as ir


def test_records_go_back_to_their_sites_call_by_call():
    assert sites.by_site(["a cars", "a Sponza", "b cars", "b Sponza"]) == {"cars": ("a cars", "b cars"), "Sponza": ("a Sponza", "b Sponza")}


@pytest.mark.parametrize("records", [[], ["a cars"], ["a cars", "a Sponza", "b cars"]])
def test_records_of_some_sites_alone_are_refused(records):
    with pytest.raises(ValueError, match="cars, Sponza"):
        sites.by_site(records)


def test_tables_stand_below_each_other_under_their_sites():
    made = sites.tables(lambda one: pd.DataFrame({"length": {"whole": len(one)}}), ["four", "eleven"])
    assert made["length"].to_dict() == {("cars", "whole"): 4, ("Sponza", "whole"): 6}


def test_every_site_has_the_same_suns_and_the_lobe_that_is_asked_for():
    try:
        scenes = [at.scene(150.0) for at in sites.SITES.values()]
    except FileNotFoundError as absent:
        pytest.skip(str(absent))
    assert scenes[0].lights == scenes[1].lights and len(scenes[0].lights) == 10
    for scene, at in zip(scenes, sites.SITES.values(), strict=True):
        assert {at.whole, at.bent} <= set(scene.cameras)
        assert {(mesh.material.lobe, mesh.material.exponent) for mesh in scene.meshes} == {("phong", 150)}
        assert min(min(mesh.material.specular) for mesh in scene.meshes) >= two_cars.LOBE - 1e-9


@pytest.mark.parametrize("site", sites.SITES)
def test_suns_light_much_of_what_a_site_shows(site):
    at = sites.SITES[site]
    try:
        scene = at.scene(50.0)
    except FileNotFoundError as absent:
        pytest.skip(str(absent))
    for camera in (at.whole, at.bent):
        image = ir.methods.PathTracing(bounces=0).render(scene, camera, size=(87, 57)).image
        assert (image.mean(2) > 0.02).mean() > 0.2, camera


def test_blocks_are_means_and_cut_what_is_left_over():
    image = np.arange(5 * 3 * 3, dtype=np.float32).reshape(5, 3, 3)
    made = figure_7.blocks(image)
    assert made.shape == (2, 1, 3) and np.allclose(made[1, 0], image[2:4, :2].mean((0, 1)))
