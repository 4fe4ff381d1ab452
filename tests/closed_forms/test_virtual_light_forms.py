"""Closed forms by virtual lights: disks that stand for an emitter, or for the lit cap of a sphere, come to them as they grow in number."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import interreflect as ir
from interreflect import _core, stages


class Lit:
    """What `measure` reads: emission, and light that disks bring."""

    def __init__(self, case, camera, lights):
        gbuffer = ir.trace_gbuffer(case.scene, camera, case.size)
        shadows = ir.shadow_lights(ir.TracedVisibility(), lights, case.scene)
        light = ir.shade_lights(ir.DiskIntegral(), lights, shadows, gbuffer, case.scene)
        self.image = self.direct = stages.shade(gbuffer, light.gathered, light.glossy) + np.asarray(gbuffer.emission)


def cut(corners, cuts):
    """Middles of the cuts^2 equal triangles of one."""
    a, b, c = corners
    for i in range(cuts):
        for j in range(cuts - i):
            yield a + (b - a) * (i + 1 / 3) / cuts + (c - a) * (j + 1 / 3) / cuts
            if i + j < cuts - 1:
                yield a + (b - a) * (i + 2 / 3) / cuts + (c - a) * (j + 2 / 3) / cuts


def disks(scene, cuts):
    """A disk for each of cuts^2 pieces of every emitting triangle."""
    position, normal, flux, area = [], [], [], []
    for mesh in scene.meshes:
        for triangle in np.asarray(mesh.triangles) if max(mesh.material.emission) > 0 else ():
            corners = np.asarray(mesh.positions, float)[triangle] @ mesh.transform[:3, :3].T + mesh.transform[:3, 3]
            across = np.cross(corners[1] - corners[0], corners[2] - corners[0])
            size = np.linalg.norm(across) / 2
            for middle in cut(corners, cuts):
                position.append(middle)
                normal.append(across / (2 * size))
                area.append(size / cuts**2)
                flux.append(np.pi * np.asarray(mesh.material.emission) * area[-1])
    arrays = (np.ascontiguousarray(array, np.float32) for array in (position, normal, flux, area, np.full(len(area), 1e-5)))
    return _core.VirtualLights(*arrays)


# Errors fall with the number of disks; measured .0018, .0033, -.0121, .024, .012, -.0073, .0082, .0023 with the last of `cuts`.
@pytest.mark.parametrize(("row", "knobs", "cuts", "bound"), [
    (5, {}, (1, 2, 4), 0.003),
    (5, {"distance": 0.5}, (1, 2, 4), 0.005),
    (6, {}, (1, 2, 4), 0.015),  # the edge that both squares share is the hardest
    (7, {}, (1,), 0.03),
    (7, {"other_radius": 0.5, "distance": 2}, (1,), 0.015),
    (8, {}, (1, 2), 0.01),
    (8, {"offset": 1}, (1, 2), 0.01),
    (12, {}, (1, 2, 4), 0.004),
])  # fmt: skip
def test_disks_come_to_the_form_factor_as_they_grow_in_number(row, knobs, cuts, bound):
    case = ir.scenes.closed_form(row, **knobs)
    errors = []
    for n in cuts:
        lights = disks(case.scene, n)
        errors.append(abs(case.measure(*(Lit(case, camera, lights) for camera in case.cameras)) / case.value - 1))
    assert errors[-1] < bound, errors
    assert all(later < 0.6 * earlier for earlier, later in pairwise(errors)), errors


def test_the_integrating_sphere_is_one_colour_whatever_the_number_of_lights():
    case = ir.scenes.closed_form(4)
    errors, spread = [], []
    for lights in (4, 16, 64):
        method = ir.methods.VirtualAreaLights(
            sample_lights=ir.HaltonLights(lights=lights), cluster_lights=ir.KMeans(iterations=8), shade_lights=ir.DiskIntegral(),
            shadow_lights=ir.TracedVisibility(), filter_shadows=ir.SimpleLookup(), share=ir.EveryPixel(),
        )  # fmt: skip
        indirect = np.asarray(method.render(case.scene, camera=case.camera, size=(48, 48)).indirect)[..., 0] * case.scale / case.value
        errors.append(abs(indirect.mean() - 1))
        spread.append(indirect.std())
    # Measured .154, .040, .010.
    assert errors[-1] < 0.015, errors
    assert all(later < 0.5 * earlier for earlier, later in pairwise(errors)), errors
    assert spread[-1] < 0.05 and spread[-1] < spread[0], spread


@pytest.mark.parametrize(("name", "value", "message"), [
    ("position", np.zeros((2, 3), np.float64), "position must have dtype float32"),
    ("position", np.full((1, 3), np.nan, np.float32), "light 0: position must be finite"),
    ("normal", np.array([[0, 2, 0]], np.float32), "light 0: normal must have length 1"),
    ("flux", np.array([[0, -1, 0]], np.float32), "light 0: flux must be finite and not negative"),
    ("area", np.array([-1], np.float32), "light 0: area must be finite and not negative"),
    ("area", np.array([1, 2], np.float32), "area must have as many entries as position, 1"),
    ("offset", np.array([np.inf], np.float32), "light 0: offset must be finite and not negative"),
])  # fmt: skip
def test_lights_of_ones_own_are_checked(name, value, message):
    right = {
        "position": np.zeros((1, 3), np.float32), "normal": np.array([[0, 1, 0]], np.float32), "flux": np.ones((1, 3), np.float32),
        "area": np.ones(1, np.float32), "offset": np.zeros(1, np.float32),
    }  # fmt: skip
    assert len(_core.VirtualLights(**right)) == 1
    with pytest.raises(ValueError, match=message):
        _core.VirtualLights(**{**right, name: value})


@pytest.mark.parametrize("bounces", [1, 2, 4])
def test_further_bounces_add_up_as_in_a_furnace(bounces):
    """Of closed form 4 with all bounces, n of them hold 1 - rho^n, rho = .5. Measured: .995, .986 and .982 of that."""
    case = ir.scenes.closed_form(4, bounces=None)
    method = ir.methods.VirtualAreaLights(
        bounces=bounces, map_size=256, shadow_lights=ir.TracedVisibility(), filter_shadows=ir.SimpleLookup()
    )
    indirect = np.asarray(method.render(case.scene, camera=case.camera, size=(32, 32)).indirect)[..., 0] * case.scale / case.value
    assert indirect.mean() == pytest.approx(1 - 0.5**bounces, rel=0.025)
    assert indirect.std() < 0.02
