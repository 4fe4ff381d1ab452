"""A deliberate fault in every stage of virtual area lights, and the closed form or truth that notices it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from faults import is_noticed, overwrite

import interreflect as ir

METHOD = ir.methods.VirtualAreaLights(
    map_size=256, share=ir.EveryPixel(), shadow_lights=ir.ImperfectShadowMaps(), filter_shadows=ir.Pcss(), shade_lights=ir.DiskVector()
)
SPHERE = METHOD.replace({"sample_lights.lights": 64, "shadow_lights": ir.TracedVisibility(), "filter_shadows": ir.SimpleLookup()})
SIZE = (64, 48)


def sphere(method=SPHERE, tolerance=0.03):
    """Closed form 4: the mean of the picture, and how even it is."""

    def read():
        case = ir.scenes.closed_form(4)
        indirect = np.asarray(method.render(case.scene, case.camera, size=(32, 32)).indirect)[..., 0] * case.scale / case.value
        return max(abs(indirect.mean() - 1), 0.3 * indirect.std()) / tolerance

    return read


@cache
def truth():
    return ir.methods.PathTracing(spp=1024, bounces=1).render(ir.scenes.cornell_box(light="spot"), size=SIZE).indirect


def cornell_box(method=METHOD, tolerance=0.15):
    """Root mean square error over the mean, of 4 x 4 pixels; measured .10."""

    def blocks(image):
        return np.asarray(image).reshape(SIZE[1] // 4, 4, SIZE[0] // 4, 4, 3).mean((1, 3))

    def read():
        made = blocks(method.render(ir.scenes.cornell_box(light="spot"), size=SIZE, seed=1).indirect)
        return float(np.sqrt(np.square(made - blocks(truth())).mean()) / truth().mean()) / tolerance

    return read


def half_flux(stage, *arguments, **keys):
    maps = stage(*arguments, **keys)
    for one in maps.maps:
        overwrite(one.flux, one.flux / 2)
    return maps


def seeds_at_one_texel(stage, *arguments):
    lights = stage(*arguments)
    for name in ("position", "normal"):
        values = getattr(lights, name)
        overwrite(values, np.broadcast_to(values[:1], values.shape))
    return lights


def centres_flux(stage, technique, *rest):
    lights = stage(technique, *rest)
    overwrite(lights.flux, lights.flux * np.asarray(lights.members)[:, None] / max(np.asarray(lights.members).mean(), 1))
    return lights


def normals_turned(stage, *arguments):
    lights = stage(*arguments)
    overwrite(lights.normal, lights.normal[:, [1, 2, 0]])
    return lights


def maps_exchanged(stage, *arguments):
    shadows = stage(*arguments)
    overwrite(shadows.depth, shadows.depth[::-1])
    return shadows


def maps_mirrored(stage, *arguments):
    shadows = stage(*arguments)
    overwrite(shadows.depth, shadows.depth[:, :, ::-1])
    return shadows


def areas_for_flux(stage, technique, lights, *rest):
    """The paper's numerator, for radiosity in place of flux (ERRATA.md)."""
    overwrite(lights.flux, lights.flux / np.maximum(np.asarray(lights.area), 1e-3)[:, None])
    return stage(technique, lights, *rest)


UNCLUSTERED = METHOD.replace({"cluster_lights": None, "sample_lights.lights": 512})
FAULTS = {
    "half the flux in maps": ("light_maps", half_flux, sphere()),
    "all seeds at one texel": ("sample_lights", seeds_at_one_texel, cornell_box(UNCLUSTERED, 0.3)),
    "flux counted by members twice": ("cluster_lights", centres_flux, cornell_box()),
    "normals of clusters turned": ("cluster_lights", normals_turned, sphere()),
    "maps of other lights": ("shadow_lights", maps_exchanged, cornell_box()),
    "maps mirrored": ("shadow_lights", maps_mirrored, cornell_box()),
    "area missing in the form factor": ("shade_lights", areas_for_flux, sphere()),
}


def test_every_stage_of_its_own_has_a_fault():
    assert {stage for stage, _, _ in FAULTS.values()} == {"light_maps", "sample_lights", "cluster_lights", "shadow_lights", "shade_lights"}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_noticed_and_the_sound_stage_passes(fault, monkeypatch):
    is_noticed(monkeypatch, "virtual_area_lights", *FAULTS[fault])
