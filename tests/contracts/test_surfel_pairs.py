"""Every pair of techniques of illuminance composition works together: whatever stages the two are of, in some whole frame."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from tests.contracts.all_pairs import rows_of_all_pairs
from tests.contracts.test_pairs import played, reference

import interreflect as ir

STAGES = ("place_surfels", "cluster_surfels", "place_caches", "link", "evaluate", "shade", "shadow")
CHOICES = {stage: tuple(t for t in ir.techniques(stage) if t is not ir.VoxelCones) for stage in STAGES}
ROWS = [tuple(of[n] for of, n in zip(CHOICES.values(), row, strict=True)) for row in rows_of_all_pairs(CHOICES)]
QUICK = {
    "RelaxedSurfels": {"surfels": 1500, "iterations": 2}, "HaltonSurfels": {"surfels": 1500}, "XorshiftSurfels": {"surfels": 1500},
    "CacheGrid": {"nx": 6, "ny": 6, "nz": 6}, "LightMap": {"texels": 48, "grid": ir.CacheGrid(nx=6, ny=6, nz=6)},
    "AllSurfels": {"samples": 200, "near_rays": 64}, "ShLinks": {"links": 96, "near_rays": 64},
    "RuntimeProjection": {"links": 96, "near_rays": 64}, "ShadowMap": {"size": 256},
    "FluxLinks": {"links": 96, "candidates": 192, "near_rays": 64},
}  # fmt: skip


def method_of(row):
    made = {stage: t(**QUICK.get(t.__name__, {})) for stage, t in zip(STAGES, row, strict=True)}
    return ir.methods.IlluminanceComposition(**made)


def test_the_rows_hold_every_pair():
    held = {frozenset(pair) for row in ROWS for pair in itertools.combinations(zip(STAGES, row, strict=True), 2)}
    named = [(stage, technique) for stage, of in CHOICES.items() for technique in of]
    every = {frozenset((a, b)) for a, b in itertools.combinations(named, 2) if a[0] != b[0]}
    assert every == held


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(t.__name__ for t in row))
def test_techniques_of_any_two_stages_work_together(row):
    frame = played(method_of(row))
    assert np.isfinite(frame.image).all() and frame.image.min() >= 0
    assert 0.6 < frame.indirect.mean() / reference().indirect.mean() < 1.4
