"""The part that methods built on voxels have in common: from a scene to lit, filtered hierarchies."""

from __future__ import annotations

from typing import Any

from interreflect import _core
from interreflect.methods.bodies import parts_of, voxelize_bodies
from interreflect.methods.knobs import knob, stage
from interreflect.methods.method import Method, method
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import View
from interreflect.profile import Profile
from interreflect.scenes.scene import Scene
from interreflect.stages import holds_all_bounces, light_history, light_voxels, place, prefilter, voxelize


@method
class VoxelMethod(Method):
    """A method with the stages voxelize, light_voxels and prefilter, whose voxels live in `grid`.

    With `bodies="apart"` every body has a hierarchy of its own, which is voxelized once and lit and filtered in every frame [Rehfeld et
    al. 2014, 3.1].
    """

    grid: _core.Grid = _core.Grid(resolution=128)
    voxelize: Any = stage(default=_core.SurfaceSampling())
    light_voxels: Any = stage(default=_core.TracedLighting(both_sides=True))
    prefilter: Any = stage(default=_core.OctantCoverage())
    bodies: str = knob(
        default="together", doc="whether bodies share the scene's voxels, or keep voxels of their own that move with them",
        choices=("together", "apart"),
    )  # fmt: skip

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.bodies == "apart" and holds_all_bounces(self.light_voxels):
            raise ValueError(f"{type(self).__name__}: Bounces gathers in one hierarchy; it does not go with bodies='apart'")

    @property
    def bounces(self) -> int | None:
        """One; all where `light_voxels` gathers them from frame to frame."""
        return None if holds_all_bounces(self.light_voxels) else 1

    def precompute(self, scene: Scene, pieces: Pieces) -> dict[str, Any]:
        """Voxels of the bodies, as large as those of the first camera's grid; without a camera they wait for the first frame."""
        if self.bodies == "together" or not scene.cameras:
            return {}
        return {"bodies": voxelize_bodies(self.voxelize, scene, place(self.grid, scene).voxel_size)}

    def pyramids(self, view: View, profile: Profile, history: Any) -> list[_core.Pyramid]:
        """The stages up to `prefilter`: one hierarchy of everything, or one of what stands still and of each body. history: what
        `kept_light` returned for the frame before."""
        scene = view.scene
        with profile.stage("voxelize") as note:
            domain = place(self.grid, scene, view.camera, view.size)
            apart = self.bodies == "apart"
            parts = parts_of(self.voxelize, view, domain, note) if apart else [note(voxelize(self.voxelize, scene, domain))]
        with profile.stage("light_voxels") as note:
            lit = [note(self._light(scene, parts, k, view.seed, history)) for k in range(len(parts))]
        with profile.stage("prefilter") as note:
            return [note(prefilter(self.prefilter, one)) for one in lit]

    def kept_light(self, pyramids: list[_core.Pyramid]) -> Any:
        """What the next frame's lighting builds on; None where it builds on nothing."""
        kept = [light_history(self.light_voxels, pyramid) for pyramid in pyramids]
        return kept if self.bodies == "apart" and kept[0] is not None else kept[0]

    def _light(self, scene: Scene, parts: list[_core.VoxelGrid], k: int, seed: int, history: Any) -> _core.LitVoxels:
        """Part k, as lit as the others let it be."""
        last = history[k] if isinstance(history, list) else history
        return light_voxels(self.light_voxels, scene, parts[k], seed, history=last, others=parts[:k] + parts[k + 1 :])
