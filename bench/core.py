"""The suite `core`: everything that the first part of the laboratory has to be quick at."""

from __future__ import annotations

from typing import Any

from bench import house_rows, path_rows, sponza, visibility_rows, voxel_rows
from bench.calibration import Calibration, calibrate
from bench.rows import Row


def run(peers: Any) -> tuple[Calibration, list[Row]]:
    """Calibrates, then measures every row. peers: the module `_peers`."""
    scene = sponza.load(peers)
    calibration = calibrate(scene)
    groups = (visibility_rows, voxel_rows, path_rows)
    measured = [row for group in groups for row in group.rows(calibration, scene)]
    return calibration, measured + house_rows.rows()
