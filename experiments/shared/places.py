"""Every scene that methods meet on: two that are built in, and each manifest of the scenes' folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

import interreflect as ir
from experiments.shared.scenes import load
from interreflect.scenes.load import scene_folders

STEP = 0.25  # of a voxel of 128 along the scene's longest side: how far the camera, or a lamp without direction, moves in a frame
TURN = 0.5  # degrees a frame of a light with a direction


@dataclass(frozen=True)
class Place:
    """A scene by name, seen by its first camera. FileNotFoundError of `make` says where it was looked for."""

    name: str
    make: Callable[[], ir.Scene]


BUILT_IN = (
    Place("cornell box by a spot", lambda: ir.scenes.cornell_box(light="spot")),
    Place("atrium", ir.scenes.atrium),
)


def manifests() -> list[Place]:
    """The scenes' folder, where there is one: a place for each manifest, by name."""
    root = next((folder for name in scene_folders() if (folder := Path(name)).is_dir()), None)
    if root is None:
        return []
    paths = sorted(str(path.relative_to(root)) for path in root.rglob("*.toml"))
    return [Place(path.removesuffix(".toml").removesuffix("/scene"), partial(load, path)) for path in paths]


def places() -> Mapping[str, Place]:
    return {place.name: place for place in (*BUILT_IN, *manifests())}


# Of all kinds: a box, a court, two halls, a room lit through a door and one through windows.
KINDS = ("cornell box by a spot", "atrium", "sponza_crytek", "sibenik", "veach_ajar", "living_room")


def of_all_kinds() -> list[Place]:
    """Those of KINDS that are here."""
    here = places()
    return [here[name] for name in KINDS if name in here]


def scenes() -> list[ir.Scene]:
    """All of them, each loaded once."""
    return [place.make() for place in places().values()]


def moved(scene: ir.Scene, frames: int) -> ir.Motion:
    """The first camera goes sideways while a light moves: the first that has a place or a direction, else an environment's image."""
    camera = next(iter(scene.cameras.values()))
    ahead = np.subtract(camera.target, camera.position)
    right = np.cross(ahead, camera.up)
    x, y, z = (float(value) for value in STEP * right / np.linalg.norm(right))
    lamps = [index for index, light in enumerate(scene.lights) if not isinstance(light, ir.EnvironmentLight)]
    skies = [index for index, light in enumerate(scene.lights) if isinstance(light, ir.EnvironmentLight)]
    light = next(iter([*lamps, *skies]), None)
    if light is None:
        return ir.Motion(frames=frames, camera_by=(x, y, z), voxels=128)
    if isinstance(scene.lights[light], ir.PointLight):
        return ir.Motion(frames=frames, camera_by=(x, y, z), voxels=128, light=light, light_by=(x, y, z))
    return ir.Motion(frames=frames, camera_by=(x, y, z), voxels=128, light=light, light_turn=TURN)
