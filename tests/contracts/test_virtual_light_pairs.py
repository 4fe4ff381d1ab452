"""Every pair of techniques of virtual area lights works together: whatever stages the two are of, in some whole frame."""

from __future__ import annotations

import numpy as np
import pytest
from tests.contracts.all_pairs import every_pair, pairs_of, rows_of_all_pairs
from tests.contracts.test_pairs import played, reference

import interreflect as ir

STAGES = ("sample_lights", "cluster_lights", "shadow_lights", "filter_shadows", "shade_lights", "share", "shade", "shadow")
CHOICES = {stage: tuple(t for t in ir.techniques(stage) if t is not ir.VoxelCones) for stage in STAGES}
CHOICES["cluster_lights"] = (*CHOICES["cluster_lights"], None)
ROWS = rows_of_all_pairs(CHOICES)
QUICK = {
    "EveryRsmPixel": {"samples": 200}, "HaltonLights": {"lights": 60}, "ImperfectShadowMaps": {"points": 20_000, "size": 64},
    "TracedDisk": {"samples": 1}, "Pcss": {"blocker_samples": 4, "filter_samples": 4}, "Pcf": {"samples": 4}, "ShadowMap": {"size": 256},
}  # fmt: skip


def method_of(row):
    changes = {stage: CHOICES[stage][number] for stage, number in zip(CHOICES, row, strict=True)}
    made = {stage: None if t is None else t(**QUICK.get(t.__name__, {})) for stage, t in changes.items()}
    return ir.methods.VirtualAreaLights(map_size=128, emitter_views=4, environment_lights=4, **made)


def test_the_rows_hold_every_pair():
    assert set().union(*(pairs_of(CHOICES, row) for row in ROWS)) == every_pair(CHOICES)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(map(str, row)))
def test_techniques_of_any_two_stages_work_together(row):
    method = method_of(row)
    frame = played(method)
    assert np.isfinite(frame.image).all() and frame.image.min() >= 0
    # Points have no bound beside a light; unshadowed ones shine through the blocks; clamped ones and disks seen from their middle lose.
    most = 3.0 if isinstance(method.shade_lights, ir.Point) else 1.6
    assert 0.5 < frame.indirect.mean() / reference().indirect.mean() < most
