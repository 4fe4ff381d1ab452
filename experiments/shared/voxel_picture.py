"""A method whose picture is the voxels themselves, and whose counts say where they differ from the surface."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

import interreflect as ir
from interreflect import _core
from interreflect.coverage import voxel_coverage
from interreflect.cubes import VoxelView, voxel_view
from interreflect.frame import Image
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.stages import light_voxels, place, prefilter, trace_gbuffer, voxelize

# A ray that passes the surface by more than two diagonals of the voxels there went between voxels: a voxel that the surface touches
# has its far corner within one diagonal of it, and one more allows for rays that leave the first layer through a step of it.
PASSED = 2.0


@method
class VoxelPicture(Method):
    """Voxels as shaded cubes.

    Counts of the stage `compare`: `voxels`, `exact`, `missing`, `holes` and `extra` as `voxel_coverage` has them; `seen` pixels that show
    a surface and `cracked` ones of these, through which one looks past it between the voxels. Of `light_voxels`: `lit` ones with radiance.

    light_voxels=None shows albedo; prefilter=None the voxels themselves, else a level of their pyramid.
    """

    grid: _core.Grid = _core.Grid(resolution=256)
    voxelize: Any = stage(default=_core.SurfaceSampling())
    light_voxels: Any = stage(default=None, optional=True)
    prefilter: Any = stage(default=None, optional=True)
    level: int = knob(default=0, doc="level of the pyramid that is shown", minimum=0, maximum=10)
    exact: bool = knob(default=True, doc="whether voxels are compared with those that the surface touches")

    bounces: ClassVar[int | None] = 0

    def compose(self, view: View, profile: Profile) -> tuple[Image, Image]:
        scene, camera, size = view.scene, view.camera, view.size
        domain = place(self.grid, scene, camera, size)
        with profile.stage("voxelize") as note:
            voxels = note(voxelize(self.voxelize, scene, domain))
        shown: Any = voxels
        if self.light_voxels is not None or self.prefilter is not None:
            with profile.stage("light_voxels") as note:
                shown = note(light_voxels(self.light_voxels or _core.TracedLighting(), scene, voxels, view.seed))
                note.counts["lit"] = int(shown.radiance.any(1).sum())
        if self.prefilter is not None:
            with profile.stage("prefilter") as note:
                shown = note(prefilter(self.prefilter, shown))
        with profile.stage("view"):
            drawn = voxel_view(shown, camera, size, level=self.level)
        if self.exact:
            with profile.stage("compare") as note:
                note.counts.update(compare(scene, voxels, drawn, view))
        return drawn.image, np.zeros_like(drawn.image)


def compare(scene: ir.Scene, voxels: Any, drawn: VoxelView, view: View) -> dict[str, int]:
    """How voxels differ from those that the surface touches, and how far one sees through them."""
    coverage = voxel_coverage(voxels, voxelize(_core.ExactOverlap(), scene, voxels.domain))
    gbuffer = trace_gbuffer(scene, view.camera, view.size)
    position, depth = gbuffer.position.reshape(-1, 3), np.array(gbuffer.depth)
    place = voxels.domain.to_voxels(position)
    inside = ((place >= 0) & (place < voxels.domain.cells)).all(1).reshape(depth.shape)
    seen = np.isfinite(depth) & inside
    size = np.full(depth.shape, np.inf)
    size[seen] = diagonals(voxels.domain, position[seen.ravel()])
    return {
        "voxels": coverage.voxels,
        "exact": coverage.exact,
        "missing": coverage.missing,
        "holes": coverage.holes,
        "extra": coverage.extra,
        "faces": drawn.faces,
        "seen": int(seen.sum()),
        "cracked": int(cracks(depth, drawn.depth, size)[seen].sum()),
    }


def diagonals(domain: _core.Domain, position: NDArray[np.floating]) -> NDArray[np.floating]:
    """(n,): length of the longest diagonal of the voxels at (n, 3) points, scene units."""
    across = np.linalg.inv(domain.density(position).astype(np.float64))  # columns: a voxel's edges
    ways = np.array([[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]])
    return np.asarray(np.linalg.norm(across @ ways.T, axis=1).max(1))


def cracks(surface: NDArray[np.floating], voxels: NDArray[np.floating], diagonal: NDArray[np.floating]) -> NDArray[np.bool_]:
    """Pixels whose ray passes the surface by more than `PASSED` diagonals of the voxels there. All (height, width); depths along rays."""
    return np.asarray(np.where(np.isfinite(surface), surface, np.inf) + PASSED * diagonal < voxels)
