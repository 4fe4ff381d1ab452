"""Every pair of techniques of voxel cone tracing works together: whatever stages the two are of, in some whole frame."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from tests.contracts.all_pairs import every_pair, pairs_of, rows_of_all_pairs
from tests.contracts.test_march import room

import interreflect as ir

SIZE = (48, 36)
GRIDS = {"Nested": ir.Grid(resolution=24, cascades=2), **{t.__name__: ir.Grid(resolution=32, warp=t()) for t in ir.techniques("warp")}}
STAGES = ("voxelize", "light_voxels", "prefilter", "march", "glossy", "share", "shadow", "sky", "shade")
CHOICES = {"grid": tuple(GRIDS.values()), **{stage: tuple(ir.techniques(stage)) for stage in STAGES}}


ROWS = rows_of_all_pairs(CHOICES)


@cache
def scene():
    """Glossy, and open to a faint sky through nothing: every stage has work."""
    closed = room(specular=(0.1,) * 3, roughness=0.4)
    return closed.replace(lights=[*closed.lights, ir.EnvironmentLight(radiance=(0.1,) * 3)])


def method_of(row):
    changes = {stage: CHOICES[stage][number] for stage, number in zip(CHOICES, row, strict=True)}
    quick = {"TracedRays": {"samples": 8}, "ShadowMap": {"size": 256}, "ShadowMapInjection": {"size": 256}, "TracedSky": {"samples": 2}}
    made = {s: c if s == "grid" else c(**quick.get(c.__name__, {})) for s, c in changes.items()}
    return ir.methods.VoxelConeTracing(**made)


def test_the_rows_hold_every_pair():
    assert set().union(*(pairs_of(CHOICES, row) for row in ROWS)) == every_pair(CHOICES)


def played(method):
    """The second of two frames: the first one's history is in it."""
    prepared, history, frame = method.prepare(scene()), None, None
    for _ in range(2):
        frame = prepared.render(size=SIZE, history=history)
        history = frame.history
    return frame


def sees_a_view(method):
    return isinstance(method.grid.warp, ir.Perspective | ir.Spherical)


def check_light(method, frame):
    """Voxels of a view miss the walls beside and behind it, volume coverage thins walls; further bounces add a third to a half."""
    assert np.isfinite(frame.image).all() and frame.image.min() >= 0
    least = 0.15 if sees_a_view(method) else 0.4 if isinstance(method.prefilter, ir.VolumeCoverage) else 0.65
    assert least < frame.indirect.mean() / reference().indirect.mean() < 1.6


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(map(str, row)))
def test_techniques_of_any_two_stages_work_together(row):
    method = method_of(row)
    frame = played(method)
    check_light(method, frame)
    # Beyond a view nothing is known: cones see the sky there.
    if isinstance(method.shade, ir.Exact) and not (sees_a_view(method) and isinstance(method.sky, ir.ConeSky)):
        assert frame.direct.mean() == pytest.approx(reference().direct.mean(), rel=0.1)


@cache
def reference():
    return ir.methods.PathTracing(spp=64, bounces=1).render(scene(), size=SIZE)
