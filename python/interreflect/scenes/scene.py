"""A scene: meshes on bodies, lights and cameras. A value: nothing changes in place."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from interreflect.scenes.camera import Camera
from interreflect.scenes.checks import Vector, direction, nearest_name, number, rigid_matrix, text
from interreflect.scenes.content import Content
from interreflect.scenes.digest import digest
from interreflect.scenes.lights import EnvironmentLight, Light
from interreflect.scenes.mesh import IDENTITY, Mesh

if TYPE_CHECKING:
    from interreflect import _core
    from interreflect.scenes.compile import Compiled

WORLD = "world"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Scene(Content):
    """Meshes, lights and cameras.

    meshes: Mesh values; those of one `body` move together. lights: at most one EnvironmentLight. cameras: name -> Camera, the
    first is the default. up: unit vector. unit: metres per scene unit, for captions only.
    bodies: name -> (4, 4) pose of that body in the world, identity where not given.
    warnings: what loading dropped or replaced, in words, counted.

    Raises ValueError that names the argument.
    """

    meshes: Sequence[Mesh] = ()
    lights: Sequence[Light] = ()
    cameras: Mapping[str, Camera] = field(default_factory=dict)
    name: str = ""
    up: Vector = (0.0, 1.0, 0.0)
    unit: float = 1.0
    bodies: Mapping[str, NDArray[np.float64]] = field(default_factory=dict)
    warnings: Sequence[str] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        self._set("meshes", _tuple_of("meshes", self.meshes, Mesh))
        self._set("lights", _tuple_of("lights", self.lights, Light))
        if sum(isinstance(light, EnvironmentLight) for light in self.lights) > 1:
            raise ValueError("lights must hold at most one EnvironmentLight")
        if not isinstance(self.cameras, Mapping):
            raise ValueError(f"cameras must map names to Camera values, got {type(self.cameras).__name__}")
        for name, camera in self.cameras.items():
            if not isinstance(name, str) or not isinstance(camera, Camera):
                raise ValueError(f"cameras[{name!r}] must be a Camera, got {type(camera).__name__}")
        self._set("cameras", MappingProxyType(dict(self.cameras)))
        text("name", self.name)
        self._set("up", direction("up", self.up))
        self._set("unit", number("unit", self.unit, 0, open_low=True))
        self._set("bodies", MappingProxyType(self._poses(self.bodies)))
        self._set("warnings", _tuple_of("warnings", self.warnings, str))

    def _set(self, key: str, value: Any) -> None:
        object.__setattr__(self, key, value)

    def _poses(self, given: Mapping[str, ArrayLike]) -> dict[str, NDArray[np.float64]]:
        """A pose for every body of the meshes, the world first."""
        poses = dict.fromkeys([WORLD, *dict.fromkeys(mesh.body for mesh in self.meshes)], IDENTITY)
        for name, pose in given.items():
            if name not in poses:
                raise ValueError(f"bodies[{name!r}] names no body of the scene{nearest_name(str(name), poses)}")
            if name != WORLD:
                poses[name] = rigid_matrix(f"bodies[{name!r}]", pose)
            elif not np.array_equal(np.asarray(pose), IDENTITY):
                raise ValueError(f"bodies[{name!r}] cannot move; give its meshes a body of their own")
        return poses

    def __repr__(self) -> str:
        """A line to read: scenes can hold thousands of meshes."""
        cameras = f", cameras {', '.join(self.cameras)}" if self.cameras else ""
        return f"<Scene {self.name!r}: {self.triangles} triangles, {len(self.lights)} lights{cameras}>"

    @property
    def triangles(self) -> int:
        """Number of triangles, each instance counted."""
        return sum(len(mesh.triangles) for mesh in self.meshes)

    @cached_property
    def bounds(self) -> NDArray[np.float64]:
        """(2, 3): smallest and largest corner of all triangles, scene units; zeros for a scene without triangles."""
        boxes = [box for mesh in self.meshes if (box := mesh.bounds(self.bodies[mesh.body] @ mesh.transform)) is not None]
        corners = np.array([np.min([b[0] for b in boxes], 0), np.max([b[1] for b in boxes], 0)]) if boxes else np.zeros((2, 3))
        corners.flags.writeable = False
        return corners

    def _digest(self) -> str:
        placed = tuple((mesh.hash, self.bodies[mesh.body]) for mesh in self.meshes)
        return digest("scene", placed, tuple(light.hash for light in self.lights), self.up)

    @property
    def camera(self) -> Camera:
        """The first camera. ValueError where there is none."""
        for camera in self.cameras.values():
            return camera
        raise ValueError(f"scene {self.name!r} has no camera; add one with scene.replace(cameras=...)")

    def replace(
        self,
        *,
        lights: Iterable[Light] | None = None,
        cameras: Mapping[str, Camera] | None = None,
        bodies: Mapping[str, ArrayLike] | None = None,
        materials: Mapping[str, Mapping[str, Any]] | None = None,
        name: str | None = None,
    ) -> Scene:
        """This scene with other lights, other cameras, moved bodies or other material keys; what stays is shared.

        bodies: name -> rigid (4, 4) pose in the world; bodies not named stay where they are.
        materials: material name, or "*" for all, -> keys of Material; "*" comes before the names. A Material in place of the
        keys replaces the whole. Raises ValueError for a name that the scene does not have and for a pose that is not rigid.
        """
        return Scene(
            meshes=self.meshes if materials is None else _with_materials(self.meshes, materials),
            lights=self.lights if lights is None else tuple(lights),
            cameras=self.cameras if cameras is None else cameras,
            name=self.name if name is None else name,
            up=self.up,
            unit=self.unit,
            bodies=self.bodies if bodies is None else {**self.bodies, **bodies},  # type: ignore[dict-item]
            warnings=self.warnings,
        )

    def instance(self, body: str, transforms: Iterable[ArrayLike]) -> Scene:
        """This scene and a rigid copy of `body` at each (4, 4) pose, stored once; copies are bodies `body.1`, `body.2`, ..."""
        copied = [mesh for mesh in self.meshes if mesh.body == body]
        if body == WORLD or not copied:
            movable = [name for name in self.bodies if name != WORLD]
            raise ValueError(f"body must name a body that can move, got {body!r}{nearest_name(str(body), movable)}")
        meshes, poses, number_of_copy = list(self.meshes), dict(self.bodies), 0
        for k, transform in enumerate(transforms):
            pose = rigid_matrix(f"transforms[{k}]", transform)
            number_of_copy += 1
            while f"{body}.{number_of_copy}" in poses:
                number_of_copy += 1
            poses[f"{body}.{number_of_copy}"] = pose
            meshes += [mesh.replace(body=f"{body}.{number_of_copy}") for mesh in copied]
        return Scene(
            meshes=meshes, lights=self.lights, cameras=self.cameras, name=self.name, up=self.up, unit=self.unit, bodies=poses,
            warnings=self.warnings,
        )  # fmt: skip

    @cached_property
    def _compiled(self) -> Compiled:
        from interreflect.scenes.compile import compile_scene

        return compile_scene(self)

    @property
    def core(self) -> _core.Scene:
        """The compiled core's scene; scenes that differ in lights, cameras or poses only share its hierarchies and textures."""
        return self._compiled.core

    @property
    def core_milliseconds(self) -> float:
        """Wall time of building the ray hierarchy and texture levels, also where another scene built and shares them."""
        return self._compiled.milliseconds

    @cached_property
    def still_hash(self) -> str:
        """Digest of what stays when bodies move and lights or cameras change: geometry and materials."""
        from interreflect.scenes.compile import still_digest

        return still_digest(self)

    @cached_property
    def surface_hash(self) -> str:
        """Digest of what stays when also the materials' emission changes."""
        from interreflect.scenes.compile import surface_digest

        return surface_digest(self)

    def __getstate__(self) -> dict[str, Any]:
        state = {key: value for key, value in self.__dict__.items() if key not in ("_compiled", "bounds")}
        return state | {"cameras": dict(self.cameras), "bodies": dict(self.bodies)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        known_hash = state.pop("hash", None)
        self.__dict__.update(state)
        Scene.__post_init__(self)
        if known_hash is not None:
            self._set("hash", known_hash)


def _tuple_of(argument: str, items: Any, kind: Any) -> tuple[Any, ...]:
    if isinstance(items, (str, bytes, Mapping)) or not isinstance(items, Iterable):
        raise ValueError(f"{argument} must be a sequence, got {type(items).__name__}")
    result = tuple(items)
    for k, item in enumerate(result):
        if not isinstance(item, kind):
            raise ValueError(f"{argument}[{k}] has the wrong type {type(item).__name__}")
    return result


def _with_materials(meshes: Sequence[Mesh], materials: Mapping[str, Any]) -> list[Mesh]:
    names = list(dict.fromkeys(mesh.material.name for mesh in meshes))
    for name in materials:
        if name != "*" and name not in names:
            raise ValueError(f"materials[{name!r}] names no material of the scene{nearest_name(name, names)}")
    changed = []
    for mesh in meshes:
        material = mesh.material
        for key in ("*", mesh.material.name):
            over = materials.get(key)
            if over is not None:
                material = over if not isinstance(over, Mapping) else material.replace(**over)
        changed.append(mesh if material is mesh.material else mesh.replace(material=material))
    return changed
