"""A deliberate fault in every stage of light propagation volumes, and the truth that notices it."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from faults import is_noticed, overwrite

import interreflect as ir

SIZE = (64, 48)
METHOD = ir.methods.LightPropagationVolumes(grid=ir.Grid(resolution=16))


@cache
def truth():
    return ir.methods.PathTracing(spp=512, bounces=1).render(ir.scenes.cornell_box(), size=SIZE).indirect


def cornell_box(tolerance=0.3):
    """How far the mean of the light is off the truth's; measured .1."""

    def read():
        made = METHOD.render(ir.scenes.cornell_box(), size=SIZE).indirect
        return abs(float(made.mean() / truth().mean()) - 1) / tolerance

    return read


def colours(tolerance=0.6):
    """How much redder the white back wall is beside the red wall than beside the green one, off the truth's; measured .46."""

    def redder(image):
        left, right = image[12:22, 14:24].mean((0, 1)), image[12:22, 40:50].mean((0, 1))
        return left[0] / left[1] / (right[0] / right[1])

    def read():
        made = METHOD.render(ir.scenes.cornell_box(), size=SIZE).indirect
        return abs(float(redder(np.asarray(made)) / redder(np.asarray(truth()))) - 1) / tolerance

    return read


def without_1_over_pi(stage, *arguments):
    """As the paper's lobes are printed."""
    volume = stage(*arguments)
    overwrite(volume.coefficients, np.pi * volume.coefficients)
    return volume


def blockers_that_look_away(stage, *arguments):
    volume = stage(*arguments)
    turned = np.array(volume.coefficients)
    turned[..., 1:] *= -1
    overwrite(volume.coefficients, turned)
    return volume


def grid_mirrored(stage, *arguments):
    volume = stage(*arguments)
    overwrite(volume.coefficients, np.asarray(volume.coefficients)[:, :, ::-1])
    return volume


def along_the_normal(stage, volume, gbuffer):
    """What goes the way that the surface looks, not what comes to it."""
    turned = np.array(volume.coefficients)
    turned[..., 1:] *= -1
    overwrite(volume.coefficients, turned)
    return stage(volume, gbuffer)


FAULTS = {
    "lobes without 1/pi": ("inject", without_1_over_pi, cornell_box()),
    "blockers that look away": ("geometry_volume", blockers_that_look_away, cornell_box()),
    "the grid mirrored": ("propagate", grid_mirrored, colours()),
    "light along the normal": ("look_up", along_the_normal, cornell_box()),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_is_noticed_and_the_sound_stage_passes(fault, monkeypatch):
    is_noticed(monkeypatch, "light_propagation_volumes", *FAULTS[fault])
