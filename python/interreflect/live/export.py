"""What was turned in the page, as a program that makes the same picture."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import Any

from interreflect.methods.knobs import is_technique
from interreflect.methods.method import Method
from interreflect.scenes.camera import Camera


def program(scene: str, method: Method, preset: str | None, camera: Camera, size: tuple[int, int]) -> str:
    """Python that renders this view. scene: the expression that makes the scene. preset: what the method is written as a change of."""
    return (
        f"import interreflect as ir\n\nscene = {scene}\nmethod = {method_code(method, preset)}\n"
        f"camera = {camera_code(camera)}\nframe = method.render(scene, camera, size={size})\nframe.save(\"frame.exr\")\n"
    )  # fmt: skip


def method_code(method: Method, preset: str | None = None) -> str:
    """An expression for the method: what differs from the defaults, or from a preset."""
    cls = type(method)
    base: Any = cls() if preset is None else cls.preset(preset)
    changed = {
        field.name: getattr(method, field.name)
        for field in dataclasses.fields(method)  # type: ignore[arg-type]
        if getattr(method, field.name) != getattr(base, field.name)
    }
    start = f"ir.methods.{cls.__name__}"
    if preset is None:
        return _call(start, changed)
    start += f".preset({preset!r})"
    lines = "".join(f"    {name!r}: {_code(value)},\n" for name, value in changed.items())
    return f"{start}.replace({{\n{lines}}})" if changed else start


def camera_code(camera: Camera) -> str:
    """An expression for the camera; lengths and angles in six digits, of a vector's longest component."""
    vectors = {name: _short(getattr(camera, name)) for name in ("position", "target", "up")}
    return _call("ir.Camera", {**vectors, "fov_x": _short((camera.fov_x,))[0]}, broken=False)


def _short(vector: Sequence[float]) -> tuple[float, ...]:
    digits = 5 - math.floor(math.log10(max(abs(x) for x in vector) or 1.0))
    return tuple(round(x, digits) + 0.0 for x in vector)  # no -0.0


def _code(value: Any) -> str:
    """A technique with those of its knobs that are not at their defaults, or a plain value."""
    if not is_technique(value):
        return repr(value)
    params = type(value).description["params"]
    changed = {param["name"]: getattr(value, param["name"]) for param in params if getattr(value, param["name"]) != param["default"]}
    return _call(f"ir.{type(value).__name__}", changed, broken=False)


def _call(name: str, arguments: dict[str, Any], broken: bool = True) -> str:
    words = [f"{key}={_code(value)}" for key, value in arguments.items()]
    if not broken or len(words) < 2:
        return f"{name}({', '.join(words)})"
    return f"{name}(\n" + "".join(f"    {word},\n" for word in words) + ")"
