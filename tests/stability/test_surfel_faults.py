"""A deliberate fault in every stage of illuminance composition, and the closed form or truth that notices it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from faults import is_noticed, overwrite

import interreflect as ir

METHOD = ir.methods.IlluminanceComposition(
    place_surfels=ir.HaltonSurfels(surfels=4096), place_caches=ir.LightMap(texels=64, grid=ir.CacheGrid(nx=6, ny=6, nz=6)),
    shadow=ir.TracedShadows(samples=16),
)  # fmt: skip
SIZE = (64, 48)


def furnace(method=METHOD, tolerance=0.02):
    """Closed form 2, twelve bounces (all but 1e-4 of the light): the mean, which every loss of energy lowers again and again."""

    def read():
        case = ir.scenes.closed_form(2)
        frames = [method.replace(bounces=12).render(case.scene, camera=name, size=case.size) for name in case.cameras]
        return abs(case.measure(*frames) / case.value - 1) / tolerance

    return read


@cache
def truth():
    return ir.methods.PathTracing(spp=1024, bounces=1).render(ir.scenes.cornell_box(), size=SIZE).indirect


def cornell_box(method=METHOD, tolerance=0.15):
    """Root mean square error over the mean, of 4 x 4 pixels."""

    def blocks(image):
        return np.asarray(image).reshape(SIZE[1] // 4, 4, SIZE[0] // 4, 4, 3).mean((1, 3))

    def read():
        made = blocks(method.render(ir.scenes.cornell_box(), size=SIZE).indirect)
        return float(np.sqrt(np.square(made - blocks(truth())).mean()) / np.asarray(truth()).mean()) / tolerance

    return read


def areas_halved(stage, *arguments):
    surfels = stage(*arguments)
    overwrite(surfels.area, surfels.area * np.where(np.arange(len(surfels)) % 2, 1.0, 0.25))
    return surfels


def trees_areas_of_the_left_child(stage, *arguments):
    surfels = stage(*arguments)
    inner = np.flatnonzero(np.asarray(surfels.leaves) > 1)
    area = np.array(surfels.area)
    area[inner] = area[inner - 2 * np.asarray(surfels.leaves)[inner - 1]]
    overwrite(surfels.area, area)
    return surfels


def caches_turned_round(stage, *arguments):
    sites = stage(*arguments)
    overwrite(sites.normal, -sites.normal)
    return sites


def three_links(stage, technique, *rest):
    return stage(technique.replace(links=3), *rest)


def radiosity_for_flux(stage, surfels, radiance, *rest):
    """Without the surfels' areas."""
    light = stage(surfels, radiance, *rest)
    overwrite(light.value, light.value / np.asarray(surfels.area)[:, None])
    return light


def first_band_alone(stage, *arguments, **keywords):
    caches = stage(*arguments, **keywords)
    coefficients = np.array(caches.coefficients)
    bands = coefficients.reshape(len(coefficients), 3, -1)
    bands[:, :, 1:] = 0
    overwrite(caches.coefficients, coefficients)
    return caches


def without_pi(stage, *arguments):
    """The paper's run-time projection lacks it (ERRATA)."""
    light = stage(*arguments)
    overwrite(light.gathered.irradiance, light.gathered.irradiance * np.pi)
    return light


FAULTS = {
    "a quarter of the area of every other surfel": ("place_surfels", areas_halved, furnace()),
    "nodes with the area of their left child": ("cluster_surfels", trees_areas_of_the_left_child, furnace()),
    "caches that look into the wall": ("place_caches", caches_turned_round, furnace()),
    "links to three patches": ("link", three_links, cornell_box()),
    "radiosity taken for flux": ("pull", radiosity_for_flux, furnace()),
    "caches of one band": ("light_caches", first_band_alone, cornell_box()),
    "pi forgotten": ("evaluate", without_pi, furnace()),
}


PRECOMPUTED = {"place_surfels", "cluster_surfels", "place_caches", "link"}


def test_every_stage_of_its_own_has_a_fault():
    stages = {"place_surfels", "cluster_surfels", "place_caches", "link", "pull", "light_caches", "evaluate"}
    assert {stage for stage, _, _ in FAULTS.values()} == stages


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_noticed_and_the_sound_stage_passes(fault, monkeypatch):
    module = "composition_pieces" if FAULTS[fault][0] in PRECOMPUTED else "illuminance_composition"
    is_noticed(monkeypatch, module, *FAULTS[fault])
