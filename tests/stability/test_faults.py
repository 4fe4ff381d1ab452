"""One deliberate fault a stage, and the failure, invariant or motion that notices it. A fault that goes unnoticed is a finding."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from faults import FAULTS, plant

import interreflect as ir
from interreflect.stability import invariants

CONES = ir.methods.VoxelConeTracing(grid=ir.Grid(resolution=64), share=ir.EveryPixel())
RAYS = CONES.replace(march=ir.TracedRays(samples=16), glossy=ir.TracedRays(samples=16))
FINE_RAYS = RAYS.replace({"grid.resolution": 128, "march.samples": 64})
ROWS = {row.name: row for row in ir.stability.failures}
SMALL = (32, 24)


def failure(name, value, method=CONES, size=None):
    """Error over tolerance of a row of the table."""
    row = ROWS[name] if size is None else dataclasses.replace(ROWS[name], size=size)
    return lambda: row.read(method, value).error / row.tolerance


def closed_form(row, method=FINE_RAYS, bound=0.03):
    """Error of a closed form over a bound: for rays half a voxel of 128 beside where light falls, 1 / 128, and noise of 2 %."""

    def read():
        case = ir.scenes.closed_form(row)
        return abs(case.measure(method.render(case.scene, case.camera, size=(32, 32))) / case.value - 1) / bound

    return read


def invariant(check, method=CONES, scene=None):
    """The change of an invariance check over its bound."""

    def read():
        bench = invariants._Bench(method, ir.scenes.cornell_box("point") if scene is None else scene, None, (48, 36), (0, 1))
        found = getattr(invariants, check)(bench)
        return max(0.0 if one.holds else 2.0 for one in (found if isinstance(found, list) else [found]))

    return read


def moving(motion, statistic, bound, method=CONES):
    """A temporal error over a bound."""

    def read():
        truth = ir.Reference(noise=1e-3, max_spp=256)
        return getattr(ir.stability.motion(method, ir.scenes.cornell_box("point"), motion, (48, 36), reference=truth), statistic) / bound

    return read


LAMP_SINKS = ir.Motion.moving_light(by=(0, -0.15, 0.1), frames=3)
BRIGHT = invariants.brighter(ir.scenes.cornell_box("point"), 16)
NOTICED_BY = {
    "normals of the G-buffer flipped": failure("holes and leaks of shadows", 0.1),
    "G-buffer mirrored": failure("holes and leaks of shadows", 0.1),
    "grid not snapped to voxels": failure("flicker under a dolly", 0.5),
    "axes of the voxels exchanged": failure("shift of chrominance", 1.0, size=SMALL),
    "cosine dropped at voxels": closed_form(4),
    "half the light in voxels": closed_form(4),
    "voxels clipped at 1": invariant("_linear", scene=BRIGHT),
    "stale history": moving(LAMP_SINKS, "p95", 0.1),
    "mip of half the weight": failure("occlusion by a wall", 0.25),
    "march divided by pi twice": closed_form(4, CONES, 0.07),  # what cones may lose between layers of voxels by their contract
    "march mirrored": failure("shift of chrominance", 1.0, size=SMALL),
    "rows of the march exchanged": failure("pixels without light", 0.05, size=SMALL),  # bars before the sky, which has no light to give
    "cones in steps of absolute length": failure("scene scaled up", 1e3),
    "seed depends on threads": invariant("_threads", RAYS),
    "lobe halved": failure("sharp Phong lobe", 300.0, RAYS, SMALL),
    "cosine dropped at pixels": failure("holes and leaks of shadows", 0.1),
    "no shadows": failure("holes and leaks of shadows", 0.1),
    "light of half the width": failure("penumbra", 0.3),
    "sky twice as bright": failure("occlusion by a wall", 0.2),
    "sky never hidden": failure("occlusion by a wall", 0.2),
    "albedo applied twice": closed_form(4),
    "one bounce less": failure("albedo towards 1", 0.7, ir.methods.PathTracing(spp=4)),
    "guides of the denoiser mirrored": failure("pixels without light", 0.03, ir.methods.PathTracingDenoised(spp=4), (48, 36)),
}


def test_every_stage_of_cone_tracing_and_every_method_with_stages_has_a_fault():
    assert {*NOTICED_BY} == {*FAULTS, "one bounce less", "guides of the denoiser mirrored"}
    frame = CONES.render(ir.scenes.cornell_box("point"), size=(8, 6))
    touched = {"gbuffer" if stage == "trace_gbuffer" else stage for stage, _ in FAULTS.values()}
    assert {*frame.profile.stages} <= touched


@pytest.mark.parametrize("fault", NOTICED_BY)
def test_a_planted_fault_is_noticed_and_the_sound_stage_passes(fault, monkeypatch):
    read = NOTICED_BY[fault]
    sound = read()
    assert sound <= 1, f"the sound stage fails already: {sound:.2f} of the tolerance"
    plant(monkeypatch, fault)
    assert read() > 1
    assert np.isfinite(sound)
