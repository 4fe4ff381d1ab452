"""Where a technique is shown and measured: in the first method that has its stage, on a small built-in scene."""

from __future__ import annotations

import dataclasses
from typing import Any

import interreflect as ir
from docs.generate.notes import notes_of
from interreflect import _core
from interreflect.catalogue import find_scene, parse_value
from interreflect.frame import Frame

SIZE = (200, 150)
TRUTH = ir.Reference(noise=3e-3, max_spp=256)
GRID = ("warp", "region")  # stages that are a grid's knobs


@dataclasses.dataclass(frozen=True)
class Setting:
    """A method on a view. path: the knob that holds the technique. part: which light is compared with the truth's: `image`, `direct`
    or `indirect`. frames: how many are rendered, each with the history of the one before; the last is shown."""

    method: Any
    scene_name: str
    camera: str | None
    path: str
    part: str
    frames: int = 1

    @property
    def scene(self) -> ir.Scene:
        return find_scene(self.scene_name)

    def path_of(self, knob: str) -> str:
        """Of a knob of the technique; a dotted one is another stage's."""
        return knob if "." in knob else f"{self.path}.{knob}"

    def replace(self, knob: str, value: Any) -> Setting:
        return dataclasses.replace(self, method=self.method.replace({self.path_of(knob): value}))

    def render(self, prepared: Any, size: tuple[int, int] = SIZE, seed: int = 0) -> Frame:
        frame = None
        for index in range(self.frames):
            history = None if frame is None else frame.history
            frame = prepared.render(self.camera, size=size, seed=seed * self.frames + index, history=history)
        assert frame is not None
        return frame

    def truth(self, size: tuple[int, int] = SIZE, wanted: ir.Reference = TRUTH) -> Any:
        return ir.reference(self.scene, self.camera, size, bounces=self.method.bounces, noise=wanted.noise, max_spp=wanted.max_spp)


def method_names() -> list[str]:
    """Voxel cone tracing first: most stages are shown in it."""
    return sorted(dir(ir.methods), key=lambda name: (name != "VoxelConeTracing", name))


def methods_with(stage: str) -> list[str]:
    """Every method that has a stage."""
    field = "grid" if stage in GRID else stage
    return [name for name in method_names() if hasattr(getattr(ir.methods, name)(), field)]


def setting_of(technique: type, stage: str | None = None) -> Setting:
    """The technique with its default knobs in its stage's method; its notes, or its stage's, may name another method, scene and knobs."""
    own = notes_of("techniques", technique.__name__).head
    name = stage or own.get("stage") or technique.stages[0]  # type: ignore[attr-defined]
    shared = notes_of("stages", name).head
    told = {**shared, **{key: value for key, value in own.items() if key != "knobs"}}
    base = getattr(ir.methods, told.get("method") or methods_with(name)[0])()
    path = f"grid.{name}" if name in GRID else name
    method = base.replace(_knobs(shared)).replace({path: technique()}).replace(_knobs(own))
    return Setting(
        method, told.get("scene", "cornell_box"), told.get("camera"), path, told.get("part", "indirect"), told.get("frames", 1)
    )  # fmt: skip


def _knobs(head: dict[str, Any]) -> dict[str, Any]:
    """Techniques are written as their constructors."""
    return {path: parse_value(value) if isinstance(value, str) else value for path, value in head.get("knobs", {}).items()}


def main_knob(technique: type) -> tuple[str, list[Any]] | None:
    """The knob that charts sweep, and its values: of the notes; else the first number, from a quarter of its default to four times it."""
    head = notes_of("techniques", technique.__name__).head
    if "unmeasured" in head:
        return None
    knobs = technique.description["params"]  # type: ignore[attr-defined]
    if "main_knob" in head:
        return head["main_knob"], head["values"]
    number = next((knob for knob in knobs if knob["type"] in ("int", "float") and knob["default"]), None)
    return None if number is None else (number["name"], _around(number))


def _around(knob: dict[str, Any]) -> list[Any]:
    kind = int if knob["type"] == "int" else float
    low, high = (knob[end] if knob[end] is not None else sign * float("inf") for end, sign in (("minimum", -1), ("maximum", 1)))
    values = (kind(knob["default"] * factor) for factor in (0.25, 0.5, 1, 2, 4))
    return sorted({value for value in values if low <= value <= high and not (knob["open_minimum"] and value == low)})


def techniques() -> dict[str, type]:
    """Every technique by name, in the order of the stages."""
    return {cls.__name__: cls for stage in _core.stages.values() for cls in stage["techniques"]}
