"""The suite `caches`: the stages of clustered radiance caching, how they grow, and the whole beside plain cones at every pixel.

Everything is measured on two cars in the atrium at 1742 x 1145, by the light of ten suns, with 4,096 caches of 16 x 16 texels.
"""

from __future__ import annotations

from typing import Any

from bench import cache_curve_rows, cache_pipeline, cache_stage_rows, plain_cones_rows
from bench.calibration import Calibration, calibrate
from bench.rows import Row, absent


def run(_peers: Any) -> tuple[Calibration, list[Row]]:
    """Calibrates (no limit here counts rays, so they need no peer), then measures every row."""
    calibration = calibrate(None)
    cars = cache_pipeline.load()
    if cars is None:
        return calibration, [absent("caches", "as the stages' rows say", "the car (bmw_m6/scene.toml) is not here")]
    groups = (cache_stage_rows, cache_curve_rows, plain_cones_rows)
    return calibration, [row for group in groups for row in group.rows(calibration, cars)]
