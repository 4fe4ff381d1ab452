"""Voxel cone tracing of Sponza: the whole frame with everything anew, and its cones alone."""

from __future__ import annotations

from typing import Any

import interreflect as ir
from bench import limits
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.rows import Row, absent, within
from bench.sponza import SIZE, Sponza

REPEATS = 10
FRAME, CONES = "voxel cone tracing 128^3: frame", "voxel cone tracing 128^3: cones"


def rows(calibration: Calibration, sponza: Sponza | None) -> list[Row]:
    bounds = {FRAME: 160.0, CONES: 75.0}
    if sponza is None:
        return [absent(name, f"at most {bound:g} ms", "Sponza is not here") for name, bound in bounds.items()]
    method = ir.methods.VoxelConeTracing(
        grid=ir.Grid(resolution=128), march=ir.DiffuseCones(cones=6), share=ir.Interleaved(width=2, height=2),
        shadow=ir.TracedShadows(), sky=ir.ConeSky(), glossy=None,
    )  # fmt: skip
    prepared = method.prepare(sponza.scene)
    prepared.render("nave", size=SIZE)
    profiles = [prepared.render("nave", size=SIZE).profile for _ in range(REPEATS)]
    counts = _counts(profiles[-1])
    steps = float(counts["cone_steps"])
    work = (float(counts["samples"]), float(counts["voxels"]))
    # Cones scale by a plain march's steps a second, whose loads bound them; what is around them by its limits.
    cones_scale = TARGETS_MACHINE.cone_steps / calibration.cone_steps
    around, around_elsewhere = (limits.around_cones(c, sponza.pixels, *work) for c in (calibration, TARGETS_MACHINE))
    bound = bounds[CONES] * cones_scale + (bounds[FRAME] - bounds[CONES]) * around / around_elsewhere
    limit, cones_limit = limits.voxel_frame(calibration, sponza.pixels, steps, *work), limits.cone_march(calibration, steps)
    fastest = min(profiles, key=lambda profile: profile.milliseconds)
    stages = {name: round(min(p.stages[name].milliseconds for p in profiles), 2) for name in fastest.stages}
    note = "stages in ms: " + ", ".join(f"{name} {spent:g}" for name, spent in stages.items())
    frame = within(
        FRAME, fastest.milliseconds, limit, bounds[FRAME], bound / bounds[FRAME], note=note, details={"stages": stages, "counts": counts}
    )
    return [frame, within(CONES, stages["march"], cones_limit, bounds[CONES], cones_scale)]


def _counts(profile: Any) -> dict[str, int]:
    total: dict[str, int] = {}
    for stage in profile.stages.values():
        for name, count in stage.counts.items():
            total[name] = total.get(name, 0) + count
    return total
