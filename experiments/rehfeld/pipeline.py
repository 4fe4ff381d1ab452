"""Rehfeld's voxels and cones as a method, without the caches."""

from __future__ import annotations

from typing import Any

import interreflect as ir


def rehfeld(**changes: Any) -> ir.methods.VoxelConeTracing:
    """The preset with knobs replaced; `grid__resolution=64` is the knob grid.resolution."""
    method = ir.methods.VoxelConeTracing.preset("Rehfeld 2014 voxels")
    return method.replace({name.replace("__", "."): value for name, value in changes.items()})
