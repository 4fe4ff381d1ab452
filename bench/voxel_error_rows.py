"""Errors of whole frames against the one-bounce truth: over resolutions, and of traced rays beside the cones."""

from __future__ import annotations

import itertools
from typing import Any

import interreflect as ir
from bench.calibration import Calibration
from bench.rows import Row
from bench.sponza import Sponza
from bench.voxel_pipeline import RESOLUTIONS, measured, method, sunlit_sponza

SIZE = (640, 360)
SPP = 256
REPEATS = 5
RAYS = ir.TracedRays(samples=1, tile=16)
COMPARED_AT = 128


def rows(calibration: Calibration, sponza: Sponza) -> list[Row]:
    scene = sunlit_sponza(sponza)
    truth = ir.reference(scene, "nave", SIZE, bounces=1, noise=1e-4, max_spp=SPP)
    return [over_resolutions(scene, truth), rays_beside_cones(scene, truth)]


def error(way: Any, scene: ir.Scene, truth: Any) -> float:
    """relMSE of the indirect light."""
    return float(ir.metrics.relmse(way.render(scene, "nave", size=SIZE).indirect, truth.indirect))


def over_resolutions(scene: ir.Scene, truth: Any) -> Row:
    errors, isotropic = (
        [error(method(resolution, **changes), scene, truth) for resolution in RESOLUTIONS]
        for changes in ({}, {"prefilter": ir.VolumeCoverage()})
    )
    noise = float(truth.indirect_noise)
    met = all(fine <= coarse + noise for coarse, fine in itertools.pairwise(errors))
    listed, without = (", ".join(f"{e:.4f}" for e in some) for some in (errors, isotropic))
    note = f"relMSE {listed}; with the isotropic filter {without}; the truth's own {noise:.4f}"
    details = {"errors": errors, "isotropic": isotropic, "noise": noise}
    return Row("error from 64^3 to 256^3", None, None, None, None, "falls, or stays within noise", met, note=note, details=details)


def rays_beside_cones(scene: ir.Scene, truth: Any) -> Row:
    """One ray a pixel, its random numbers shared by a tile, merged as the cones are."""
    ways = {"cones": method(COMPARED_AT), "rays": method(COMPARED_AT, march=RAYS)}
    errors = {name: error(way, scene, truth) for name, way in ways.items()}
    spent = {name: _march(way, scene) for name, way in ways.items()}
    winner = min(spent, key=lambda name: spent[name] * errors[name])
    both = "; ".join(f"{name}: {spent[name]:.1f} ms, relMSE {errors[name]:.4f}" for name in ways)
    note = f"{both}; less time x error: {winner}"
    name = f"rays shared by tiles: {COMPARED_AT}^3"
    return measured(name, spent["rays"], note, ("the cones", spent["cones"]), details={"errors": errors})


def _march(way: Any, scene: ir.Scene) -> float:
    prepared = way.prepare(scene)
    frames = [prepared.render("nave", size=(1280, 720)) for _ in range(1 + REPEATS)]
    return min(float(frame.profile.stages["march"].milliseconds) for frame in frames)
