"""Every pair of techniques of clustered radiance caching works together: whatever stages the two are of, in some whole frame."""

from __future__ import annotations

import pytest
from tests.contracts.all_pairs import every_pair, pairs_of, rows_of_all_pairs
from tests.contracts.test_pairs import GRIDS, check_light, played

import interreflect as ir

STAGES = ("light_voxels", "prefilter", "distribute", "fill", "preconvolve", "interpolate", "shade", "sky")
CHOICES = {"grid": tuple(GRIDS.values()), **{stage: tuple(ir.techniques(stage)) for stage in STAGES}}
ROWS = rows_of_all_pairs(CHOICES)
QUICK = {
    "Clustered": {"caches": 60}, "CubeFaceClustered": {"caches": 60}, "Equidistant": {"caches": 60},
    "ConeFill": {"resolution": 8}, "TracedFill": {"resolution": 8, "samples": 2}, "LobeIntegral": {"samples": 16},
    "ShadowMapInjection": {"size": 256}, "TracedSky": {"samples": 2},
}  # fmt: skip


def method_of(row):
    changes = {stage: CHOICES[stage][number] for stage, number in zip(CHOICES, row, strict=True)}
    return ir.methods.ClusteredRadianceCaching(**{s: c if s == "grid" else c(**QUICK.get(c.__name__, {})) for s, c in changes.items()})


def test_the_rows_hold_every_pair():
    assert set().union(*(pairs_of(CHOICES, row) for row in ROWS)) == every_pair(CHOICES)


@pytest.mark.parametrize("row", ROWS, ids=lambda row: "-".join(map(str, row)))
def test_techniques_of_any_two_stages_work_together(row):
    method = method_of(row)
    check_light(method, played(method))
