"""The suite `virtual-lights`: the stages of virtual area lights, how they grow, and their error beside other ways to spend the time.

Everything is measured at 1280 x 720 on the Cornell box with a glossy block and on Sponza, each by a spot.
"""

from __future__ import annotations

from typing import Any

from bench import sponza, virtual_light_curve_rows, virtual_light_error_rows, virtual_light_stage_rows
from bench.calibration import Calibration, calibrate
from bench.rows import Row, absent
from bench.virtual_light_pipeline import rooms


def run(peers: Any) -> tuple[Calibration, list[Row]]:
    """Calibrates, then measures every row. peers: the module `_peers`."""
    measured_on = sponza.load(peers)
    calibration = calibrate(measured_on)
    if measured_on is None:
        return calibration, [
            absent("virtual area lights", "as the stages' rows say", "Sponza, by whose rays limits are counted, is not here")
        ]
    found = []
    for room in rooms(measured_on.scene):
        found += virtual_light_stage_rows.rows(calibration, room)
        found += virtual_light_curve_rows.rows(calibration, room)
        found += virtual_light_error_rows.rows(calibration, room, peers=room.name == "Cornell box")
    return calibration, found
