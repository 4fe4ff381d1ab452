"""How virtual area lights grow with the number of lights: figure 9 of the paper."""

from __future__ import annotations

from bench.calibration import Calibration
from bench.rows import Row
from bench.timing import least
from bench.virtual_light_pipeline import STAGES, Pipeline, Room
from bench.voxel_pipeline import measured

REPEATS = 5
LIGHTS = (16, 32, 64, 128, 256, 512, 1024)


def rows(_calibration: Calibration, room: Room) -> list[Row]:
    spent = {lights: dict(zip(STAGES, least(*Pipeline(room, lights).works(), repeats=REPEATS), strict=True)) for lights in LIGHTS}
    whole = {lights: sum(stages.values()) for lights, stages in spent.items()}
    listed = "; ".join(
        f"{n}: {whole[n]:.1f} (clusters {s['cluster_lights']:.1f}, shadows {s['shadow_lights']:.1f}, shading {s['shade_lights']:.1f})"
        for n, s in spent.items()
    )
    each = (whole[LIGHTS[-1]] - whole[LIGHTS[0]]) / (LIGHTS[-1] - LIGHTS[0])
    note = f"ms of {listed}; {1e3 * each:.0f} us a light more"
    details = {"stages": {str(n): stages for n, stages in spent.items()}}
    return [measured(f"cost against the number of lights: {room.name}", whole[LIGHTS[-1]], note, details=details)]
