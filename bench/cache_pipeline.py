"""What the suite `caches` measures: the scene, the method, and its stages' inputs, made once."""

from __future__ import annotations

import dataclasses
from typing import Any

import interreflect as ir
from interreflect import stages

CAMERA = "cars"


@dataclasses.dataclass(frozen=True)
class Cars:
    """Every stage's input, of the full picture."""

    scene: ir.Scene
    method: ir.methods.ClusteredRadianceCaching
    size: tuple[int, int]
    gbuffer: Any
    voxels: Any
    pyramid: Any
    places: Any
    filled: Any
    convolved: Any

    @property
    def pixels(self) -> int:
        return self.size[0] * self.size[1]


def load() -> Cars | None:
    """The two cars, or None where their file is not there."""
    from experiments.shared.two_cars import SIZE, two_cars

    try:
        scene = two_cars()
    except FileNotFoundError:
        return None
    way = ir.methods.ClusteredRadianceCaching(light_voxels=ir.ConeLighting())
    gbuffer = stages.trace_gbuffer(scene, CAMERA, SIZE)
    voxels = stages.voxelize(way.voxelize, scene, stages.place(way.grid, scene, CAMERA, SIZE))
    pyramid = stages.prefilter(way.prefilter, stages.light_voxels(way.light_voxels, scene, voxels))
    places = stages.distribute(way.distribute, gbuffer, scene)
    filled = stages.fill(way.fill, places, pyramid, scene)
    return Cars(scene, way, SIZE, gbuffer, voxels, pyramid, places, filled, stages.preconvolve(way.preconvolve, filled))


def steps_of(result: Any) -> int:
    return int(result.counts.asdict()["cone_steps"])
