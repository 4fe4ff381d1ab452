"""Light that voxels lose to a coarse shadow map, and light that a march lets through an opaque layer of them.

Both sweep a knob of the method, not of the scene: a method without that knob is measured as it is.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from interreflect import _core
from interreflect.stability.failure import Reading, Trial


def injected_gaps(trial: Trial) -> Reading:
    """Mean absolute change of indirect light over its mean, `value` texels of a shadow map a voxel in the place of traced rays.

    signed: energy ratio less 1. ValueError where traced rays bring no indirect light to compare with.
    """
    traced, mapped = (trial.render(method=method).indirect.astype(np.float64) for method in _injecting(trial.method, trial.value))
    mean = traced.mean()
    if not mean > 0:
        raise ValueError("the picture has no indirect light from which gaps could be read")
    shown = (mapped.astype(np.float32), traced.astype(np.float32))
    return Reading(float(np.abs(mapped - traced).mean() / mean), *shown, signed=float(mapped.mean() / mean) - 1)


def open_layer(trial: Trial, corrected: bool) -> Reading:
    """Largest share of the sun that rays in steps of `value` diameters find past an opaque layer; the truth is 0.

    corrected: whether a step's opacity depends on its length; in the papers it does not.
    """
    method = trial.method
    if _lights_voxels(method):
        ray = _core.VoxelCones(half_angle=0.0, first_diameter=1.0, level_bias=0.0, step=trial.value, opacity_correction=corrected)
        method = method.replace(shadow=ray)
    frame = trial.render(method=method)
    direct = frame.image - frame.indirect
    return Reading(float(direct.max()), direct, np.zeros_like(direct))


def _injecting(method: Any, texels: float) -> tuple[Any, Any]:
    """The method with traced rays, and with a shadow map of so many texels a voxel, which light the same sides of voxels."""
    if not _lights_voxels(method):
        return method, method
    traced = _core.TracedLighting(both_sides=True)
    size = max(1, round(texels * _voxels_across(method)))
    return method.replace(light_voxels=traced), method.replace(light_voxels=_core.ShadowMapInjection(size=size, both_sides=True))


def _lights_voxels(method: Any) -> bool:
    return {"grid.resolution", "light_voxels", "march"} <= set(method.knobs())


def _voxels_across(method: Any) -> float:
    """Voxels of the innermost grid, as large as they are before any warp, across the scene."""
    width = method.knobs().get("grid.region.width", 1.0)  # extents
    return float(method.grid.resolution * 2 ** (method.grid.cascades - 1) / width)
