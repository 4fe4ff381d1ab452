"""Caches beside cones at every pixel, at equal error: glossy scenes, from the same lit voxels."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

import interreflect as ir
from bench.cache_pipeline import CAMERA, Cars
from bench.calibration import Calibration
from bench.rows import Row, absent
from bench.voxel_pipeline import sunlit

REPEATS = 3
SPP = 256
SPONZA = "sponza_crytek/glossy.toml"
CONES = (3, 5, 6, 9, 16)
TIMES = 2.0
TARGET = f"at most 1/{TIMES:g} of the time of cones that err no more"
# What both have alike: the scene's voxels, direct light, the sum.
ALIKE = ("gbuffer", "voxelize", "prefilter", "shadow", "sky", "shade")


@dataclasses.dataclass(frozen=True)
class Measured:
    milliseconds: float  # lighting the voxels included, the full picture
    error: float  # relMSE of the indirect light, at a quarter of the picture's width, where truth is affordable
    flip: float  # of the same


def rows(calibration: Calibration, cars: Cars) -> list[Row]:
    from experiments.shared.glossy import glossy_scenes

    found = [_beside("two cars", cars.scene, CAMERA, cars)]
    try:
        found.append(_beside("glossy Sponza", sunlit(ir.load_scene(SPONZA)), "nave", cars))
    except FileNotFoundError:
        found.append(absent(_name("glossy Sponza"), TARGET, f"{SPONZA} is not here"))
    for name, scene in zip(("glossy Cornell box", "glossy atrium"), glossy_scenes(), strict=True):
        found.append(_beside(name, scene, next(iter(scene.cameras)), cars))
    return found


def _name(scene: str) -> str:
    return f"caches beside cones at every pixel: {scene}"


def _beside(name: str, scene: ir.Scene, camera: str, cars: Cars) -> Row:
    truth = ir.reference(scene, camera, _quartered(cars.size), bounces=1, noise=1e-4, max_spp=SPP)
    ours = measure(cars.method, scene, camera, cars.size, truth)
    cones = {n: measure(plain_cones(n), scene, camera, cars.size, truth) for n in CONES}
    no_worse = [one for one in cones.values() if one.error <= ours.error]
    peer = min(no_worse, key=lambda one: one.milliseconds) if no_worse else min(cones.values(), key=lambda one: one.error)
    listed = "; ".join(f"{n} + 1 cones {one.milliseconds:.0f} ms, {one.error:.4f}" for n, one in cones.items())
    black = float(ir.metrics.relmse(np.zeros_like(truth.indirect), truth.indirect))  # above it, an error may be mended by losing light
    note = (
        f"relMSE {ours.error:.4f}; {listed}; of black {black:.4f}; the truth's own {truth.indirect_noise:.4f}; "
        f"FLIP {ours.flip:.3f}, of {len(cones)} ways of cones the least {min(one.flip for one in cones.values()):.3f}"
    )
    met = TIMES * ours.milliseconds <= peer.milliseconds and (bool(no_worse) or ours.error <= peer.error)
    of_cones = {str(n): dataclasses.asdict(one) for n, one in cones.items()}
    details = {"caches": dataclasses.asdict(ours), "cones": of_cones, "black": black}
    return Row(_name(name), ours.milliseconds, None, "plain cones", peer.milliseconds, TARGET, met, note=note, details=details)


def plain_cones(count: int) -> ir.methods.VoxelConeTracing:
    """The caches' voxels, so many diffuse cones and a glossy one at every pixel."""
    return ir.methods.VoxelConeTracing(
        grid=ir.Grid(resolution=128), light_voxels=ir.ConeLighting(), march=ir.DiffuseCones(cones=count),
        glossy=ir.GlossyCone(), share=ir.EveryPixel(),
    )  # fmt: skip


def measure(way: Any, scene: ir.Scene, camera: str, size: tuple[int, int], truth: Any) -> Measured:
    seen = way.render(scene, camera, size=_quartered(size)).indirect
    error, flip = ir.metrics.relmse(seen, truth.indirect), ir.metrics.flip(seen, truth.indirect)
    prepared = way.prepare(scene)
    spent = []
    for _ in range(1 + REPEATS):
        stages = prepared.render(camera, size=size).profile.stages
        spent.append(sum(stage.milliseconds for name, stage in stages.items() if name not in ALIKE))
    return Measured(min(spent[1:]), float(error), float(flip))


def _quartered(size: tuple[int, int]) -> tuple[int, int]:
    return (round(size[0] / 4), round(size[1] / 4))
