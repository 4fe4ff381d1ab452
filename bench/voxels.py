"""The suite `voxels`: the stages of voxel cone tracing at three resolutions, whole frames, what they hold in memory and how far they err.

Everything is measured in Sponza's nave, by the light of its sun, at 1280 x 720, with six diffuse cones.
"""

from __future__ import annotations

from typing import Any

from bench import sponza, voxel_error_rows, voxel_frame_rows, voxel_stage_rows
from bench.calibration import Calibration, calibrate
from bench.rows import Row, absent


def run(peers: Any) -> tuple[Calibration, list[Row]]:
    """Calibrates, then measures every row. peers: the module `_peers`."""
    place = sponza.load(peers)
    calibration = calibrate(place)
    if place is None:
        return calibration, [absent("voxels", "as the stages' rows say", "Sponza is not here")]
    groups = (voxel_stage_rows, voxel_frame_rows, voxel_error_rows)
    return calibration, [row for group in groups for row in group.rows(calibration, place)]
