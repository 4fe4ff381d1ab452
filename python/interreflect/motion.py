"""What moves from frame to frame: the camera, a light, or a body, each by the same step a frame."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from interreflect.scenes.camera import Camera
from interreflect.scenes.checks import Vector, direction, number, vector, whole
from interreflect.scenes.compile import rotation_about
from interreflect.scenes.lights import DirectionalLight, EnvironmentLight, PointLight, SpotLight
from interreflect.scenes.scene import WORLD, Scene

STILL: Vector = (0.0, 0.0, 0.0)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Motion:
    """`frames` frames; in each, what is named has moved one step on. Frame 0 is the scene as it is.

    camera: name, None: the scene's first. camera_by, light_by, body_by: steps in world axes, scene units; with `voxels`, in voxels of a
    grid of so many along the scene's longest side. camera_turn: degrees a frame about the camera's up, counter-clockwise seen from above.
    light: index into scene.lights. light_turn: degrees a frame of a spot's or directional light's direction, or of the environment, about
    `axis` (None: the scene's up). body: name. body_turn: degrees a frame about `axis` through the middle of the body's bounds.
    switch: (frame, factor): from that frame on the light shines `factor` times as bright. ValueError names the argument.
    """

    frames: int
    camera: str | None = None
    camera_by: Vector = STILL
    camera_turn: float = 0.0
    light: int | None = None
    light_by: Vector = STILL
    light_turn: float = 0.0
    switch: tuple[int, float] | None = None
    body: str | None = None
    body_by: Vector = STILL
    body_turn: float = 0.0
    axis: Vector | None = None
    voxels: int | None = None

    def __post_init__(self) -> None:
        whole("Motion.frames", self.frames, 1, 2**20)
        for name in ("camera_by", "light_by", "body_by"):
            object.__setattr__(self, name, vector(f"Motion.{name}", getattr(self, name)))
        for name in ("camera_turn", "light_turn", "body_turn"):
            number(f"Motion.{name}", getattr(self, name))
        if self.voxels is not None:
            whole("Motion.voxels", self.voxels, 2, 1024)
        if self.axis is not None:
            object.__setattr__(self, "axis", direction("Motion.axis", self.axis))
        if self.switch is not None:
            whole("Motion.switch[0]", self.switch[0], 0, self.frames - 1)
            number("Motion.switch[1]", self.switch[1], 0)
        if self.light is None and (self.light_by != STILL or self.light_turn or self.switch):
            raise ValueError("Motion.light must say which light moves or is switched")
        if self.body is None and (self.body_by != STILL or self.body_turn):
            raise ValueError("Motion.body must say which body moves")

    @staticmethod
    def still(camera: str | None = None, *, frames: int) -> Motion:
        """Nothing moves: what changes is flicker."""
        return Motion(camera=camera, frames=frames)

    @staticmethod
    def dolly(camera: str | None = None, *, by: Vector, frames: int, voxels: int | None = None) -> Motion:
        """The camera moves `by` a frame; with `voxels`, in voxels of a grid of so many along the scene's longest side."""
        return Motion(camera=camera, camera_by=by, frames=frames, voxels=voxels)

    @staticmethod
    def rotation(camera: str | None = None, *, by: float, frames: int) -> Motion:
        """The camera turns `by` degrees a frame about its up."""
        return Motion(camera=camera, camera_turn=by, frames=frames)

    @staticmethod
    def moving_light(light: int = 0, *, by: Vector, frames: int, camera: str | None = None, voxels: int | None = None) -> Motion:
        return Motion(camera=camera, light=light, light_by=by, frames=frames, voxels=voxels)

    @staticmethod
    def turning_light(light: int = 0, *, by: float, frames: int, axis: Vector | None = None, camera: str | None = None) -> Motion:
        return Motion(camera=camera, light=light, light_turn=by, axis=axis, frames=frames)

    @staticmethod
    def switched_light(light: int = 0, *, factor: float, at: int, frames: int, camera: str | None = None) -> Motion:
        """From frame `at` on the light is `factor` times as bright: how a method with history responds to a step."""
        return Motion(camera=camera, light=light, switch=(at, factor), frames=frames)

    @staticmethod
    def moving_body(
        body: str,
        *,
        by: Vector = STILL,
        turn: float = 0.0,
        frames: int,
        axis: Vector | None = None,
        camera: str | None = None,
        voxels: int | None = None,
    ) -> Motion:
        return Motion(camera=camera, body=body, body_by=by, body_turn=turn, axis=axis, frames=frames, voxels=voxels)

    @property
    def changes_light(self) -> bool:
        """Does anything but the camera move?"""
        return self.light is not None or self.body is not None

    @property
    def is_still(self) -> bool:
        return not self.changes_light and self.camera_by == STILL and not self.camera_turn

    def at(self, scene: Scene, frame: int) -> tuple[Scene, Camera]:
        """The scene and the camera of a frame. ValueError where the scene has no such camera, light or body."""
        from interreflect.stages import camera_of

        unit = 1.0 if self.voxels is None else _voxel_size(scene, self.voxels)
        camera = self._camera(camera_of(scene, self.camera), frame, unit)
        if self.light is not None:
            scene = scene.replace(lights=self._lights(scene, frame, unit))
        if self.body is not None:
            scene = scene.replace(bodies={self.body: self._pose(scene, frame, unit)})
        return scene, camera

    def _camera(self, camera: Camera, frame: int, unit: float) -> Camera:
        step = np.multiply(self.camera_by, unit * frame)
        position = np.add(camera.position, step)
        view = np.subtract(camera.target, camera.position)
        if self.camera_turn:
            view = rotation_about(np.divide(camera.up, np.linalg.norm(camera.up)), self.camera_turn * frame) @ view
        return dataclasses.replace(camera, position=_triple(position), target=_triple(position + view))

    def _lights(self, scene: Scene, frame: int, unit: float) -> list[Any]:
        lights, index = list(scene.lights), self.light
        if index is None or not 0 <= index < len(lights):
            raise ValueError(f"Motion.light must name one of the scene's {len(lights)} lights, got {index}")
        light = _moved(lights[index], np.multiply(self.light_by, unit * frame))
        if self.light_turn:
            light = _turned(light, np.asarray(self.axis or scene.up, float), self.light_turn * frame)
        if self.switch is not None and frame >= self.switch[0]:
            light = dimmed(light, self.switch[1])
        lights[index] = light
        return lights

    def _pose(self, scene: Scene, frame: int, unit: float) -> NDArray[np.float64]:
        if self.body is None or self.body not in scene.bodies or self.body == WORLD:
            movable = [name for name in scene.bodies if name != WORLD]
            raise ValueError(f"Motion.body must name a body of the scene ({', '.join(movable) or 'it has none'}), got {self.body!r}")
        pose = scene.bodies[self.body]
        boxes = [mesh.bounds(pose @ mesh.transform) for mesh in scene.meshes if mesh.body == self.body]
        corners = np.concatenate([box for box in boxes if box is not None])
        middle = (corners.min(0) + corners.max(0)) / 2
        turn = np.eye(4)
        turn[:3, :3] = rotation_about(np.asarray(self.axis or scene.up, float), self.body_turn * frame)
        turn[:3, 3] = middle - turn[:3, :3] @ middle + np.multiply(self.body_by, unit * frame)
        return np.asarray(turn @ pose)


def _voxel_size(scene: Scene, voxels: int) -> float:
    from interreflect._core import Grid
    from interreflect.stages import place

    return float(place(Grid(resolution=voxels), scene).voxel_size)


def _moved(light: Any, step: NDArray[np.float64]) -> Any:
    if not step.any():
        return light
    if not isinstance(light, PointLight | SpotLight):
        raise ValueError(f"Motion.light_by moves point and spot lights, got a {type(light).__name__}")
    return dataclasses.replace(light, position=_triple(np.add(light.position, step)))


def _turned(light: Any, axis: NDArray[np.float64], degrees: float) -> Any:
    if isinstance(light, SpotLight | DirectionalLight):
        return dataclasses.replace(light, direction=_triple(rotation_about(axis, degrees) @ np.asarray(light.direction)))
    if isinstance(light, EnvironmentLight):
        return dataclasses.replace(light, rotation=light.rotation + degrees)
    raise ValueError(f"Motion.light_turn turns spots, directional lights and environments, got a {type(light).__name__}")


def dimmed(light: Any, factor: float) -> Any:
    """The light, `factor` times as bright."""
    key = {DirectionalLight: "irradiance", EnvironmentLight: "radiance"}.get(type(light), "intensity")
    return dataclasses.replace(light, **{key: _triple(np.multiply(getattr(light, key), factor))})


def _triple(values: Any) -> Vector:
    x, y, z = (float(value) for value in values)
    return x, y, z
