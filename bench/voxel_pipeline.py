"""What the suite `voxels` measures: the method, the scene by its sun alone, and how bounds reach this machine."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import interreflect as ir
from bench.calibration import TARGETS_MACHINE, Calibration
from bench.rows import Row, within
from bench.sponza import Sponza

RESOLUTIONS = (64, 128, 256)
INTERLEAVED = ir.Interleaved(width=2, height=2)
Limit = Callable[[Calibration], float]


def method(resolution: int, **changes: Any) -> ir.methods.VoxelConeTracing:
    """Rasterized voxels, lit and filtered as the method does by itself; six cones, interleaved."""
    knobs: dict[str, Any] = {
        "grid": ir.Grid(resolution=resolution), "voxelize": ir.Rasterization(samples=4), "march": ir.DiffuseCones(cones=6),
        "share": INTERLEAVED, "glossy": None, "shadow": ir.TracedShadows(), "sky": ir.ConeSky(),
    }  # fmt: skip
    return ir.methods.VoxelConeTracing(**{**knobs, **changes})


def sunlit(scene: ir.Scene) -> ir.Scene:
    """The scene by its directional light alone."""
    lit = scene.replace(lights=[light for light in scene.lights if isinstance(light, ir.DirectionalLight)])
    _ = lit.core
    return lit


def sunlit_sponza(sponza: Sponza) -> ir.Scene:
    return sunlit(sponza.scene)


def bounded(
    name: str, milliseconds: float, bound: float, limit: Limit, calibration: Calibration, peer: tuple[str, float] | None = None,
    scale: float | None = None, **more: Any,
) -> Row:  # fmt: skip
    """Met within `bound` on the machine of the targets; here the bound grows as the limit does, or by `scale`."""
    here = limit(calibration)
    row = within(name, milliseconds, here, bound, here / limit(TARGETS_MACHINE) if scale is None else scale, **more)
    return row if peer is None else dataclasses.replace(row, peer=peer[0], peer_milliseconds=peer[1])


def measured(name: str, milliseconds: float | None, note: str, peer: tuple[str, float] | None = None, **more: Any) -> Row:
    """A figure without a target: it is there, and so it is met."""
    return Row(name, milliseconds, None, *(peer or (None, None)), "measured", True, note=note, **more)


def cones_scale(calibration: Calibration) -> float:
    """Cones by a plain march's steps a second, whose loads bound them."""
    return TARGETS_MACHINE.cone_steps / calibration.cone_steps
