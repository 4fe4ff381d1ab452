"""How completely a voxelization covers the surface, against the cells that triangles truly overlap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from interreflect import _core


@dataclass(frozen=True)
class VoxelCoverage:
    """Counts of voxels. `exact` are those of ExactOverlap; shares are of them.

    Nearly every voxelization misses voxels that the surface barely touches, which costs nothing as long as light cannot pass:
    holes are those of the missing voxels that leave it a way.
    """

    voxels: int
    exact: int
    missing: int
    """Voxels of ExactOverlap that are not there."""
    holes: int
    """Those of them that lie along an axis-parallel line of voxels through which light passes the surface."""
    extra: int
    """Voxels that ExactOverlap has not."""

    @property
    def missing_share(self) -> float:
        return self.missing / self.exact if self.exact else 0.0

    @property
    def hole_share(self) -> float:
        return self.holes / self.exact if self.exact else 0.0

    @property
    def extra_share(self) -> float:
        """Of ExactOverlap's voxels, so it may exceed 1."""
        return self.extra / self.exact if self.exact else 0.0


def voxel_coverage(voxels: _core.VoxelGrid, exact: _core.VoxelGrid, closed: float = 0.5) -> VoxelCoverage:
    """Compares a voxelization with ExactOverlap's of the same scene and domain. ValueError where the domains differ.

    Voxels of `exact` that follow one another along an axis are one crossing of the surface. Where not one of them is in `voxels`,
    and the surface in them closes at least the share `closed` of a voxel's face seen along that axis, they are holes. Crossings
    that close less are the surface's thin ends: light passes beside them anyway.
    """
    if voxels.domain != exact.domain:
        raise ValueError(f"voxel_coverage compares voxels of one domain, got {voxels.domain} and {exact.domain}")
    there = np.isin(exact.cell, voxels.cell, assume_unique=True)
    holes = np.zeros(len(exact), bool)
    if not there.all():
        for axis in range(3):
            holes |= _open_crossings(exact, there, axis, closed)
    missing = int((~there).sum())
    kept = len(exact) - missing
    return VoxelCoverage(len(voxels), len(exact), missing, int(holes.sum()), len(voxels) - kept)


def _open_crossings(exact: _core.VoxelGrid, there: NDArray[np.bool_], axis: int, closed: float) -> NDArray[np.bool_]:
    at, grid = exact.coordinates, exact.cell // np.prod(exact.domain.cells)  # nested grids: one after the other
    order = np.lexsort((at[:, axis], at[:, axis - 1], at[:, axis - 2], grid))
    step = np.diff(np.column_stack([at, grid])[order].astype(np.int64), axis=0)
    follows = (step[:, axis] == 1) & (step[:, axis - 1] == 0) & (step[:, axis - 2] == 0) & (step[:, 3] == 0)
    crossing = np.concatenate([[0], np.cumsum(~follows)])
    count = int(crossing[-1]) + 1
    seen = np.bincount(crossing, (exact.area * np.abs(exact.normal[:, axis]) * 0.25**grid)[order], count)
    blocked = np.bincount(crossing, there[order], count) > 0
    result = np.zeros(len(exact), bool)
    result[order] = (~blocked & (seen >= closed))[crossing]
    return result
