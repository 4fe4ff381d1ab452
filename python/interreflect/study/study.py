"""A study is a value: which scenes, which methods at which settings, and how each cell is measured."""

from __future__ import annotations

import dataclasses
import itertools
import numbers
from collections.abc import Mapping, Sequence
from typing import Any, Literal

from interreflect.study.interface import Method, Scene
from interreflect.study.reference import Reference


@dataclasses.dataclass(frozen=True)
class Cell:
    """One thing to measure: a method with its knobs on one view of one scene with one seed."""

    scene: Scene
    camera: str
    method: Method
    seed: int
    bounces: int | None  # of the truth; None: all


@dataclasses.dataclass(frozen=True, kw_only=True)
class Study:
    """Scenes x cameras x methods x seeds, each cell timed and compared with path-traced truth.

    cameras: names; every scene is seen through those it has. None: each scene's first.
    size: (width, height) in pixels. bounces: indirect bounces of the truth, one for all methods (None: all bounces);
    "method": each method's own. repeats: timed renders a cell at least; they go on to `max_repeats` until the
    median is known to 2 %, which takes six or more; 0: nothing is timed, cells may be measured side by side.
    threads: None for all. images: keep the pictures beside the records.
    ValueError names the field.
    """

    name: str
    scenes: Sequence[Scene]
    methods: Sequence[Method]
    cameras: Sequence[str] | None = None
    size: tuple[int, int] = (640, 360)
    seeds: Sequence[int] = (0,)
    bounces: int | Literal["method"] | None = "method"
    reference: Reference = dataclasses.field(default_factory=Reference)
    repeats: int = 5
    max_repeats: int = 30
    threads: int | None = None
    images: bool = True

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise ValueError(f"Study.name must be a text that is not empty, got {self.name!r}")
        for field in ("scenes", "methods", "seeds", "size"):
            _set(self, field, _sequence(field, getattr(self, field)))
        _set(self, "size", tuple(_whole("size", side, 1) for side in self.size))
        if len(self.size) != 2:
            raise ValueError(f"Study.size must be (width, height), got {self.size}")
        _set(self, "seeds", tuple(_whole("seeds", seed, 0) for seed in self.seeds))
        if len(set(self.seeds)) < len(self.seeds):
            raise ValueError(f"Study.seeds must differ, got {self.seeds}")
        if self.bounces is not None and self.bounces != "method":
            _set(self, "bounces", _whole("bounces", self.bounces, 0))
        for field, least in (("repeats", 0), ("max_repeats", 1)):
            _set(self, field, _whole(field, getattr(self, field), least))
        if self.threads is not None:
            _set(self, "threads", _whole("threads", self.threads, 1))
        if not isinstance(self.reference, Reference):
            raise ValueError(f"Study.reference must be a Reference, got {type(self.reference).__name__}")
        self._check_methods()
        self._check_cameras()

    def _check_methods(self) -> None:
        seen: dict[str, int] = {}
        for index, method in enumerate(self.methods):
            if isinstance(method, type) or not hasattr(method, "prepare"):
                raise ValueError(f"Study.methods[{index}] must be a method with its knobs, got {method!r}")
            first = seen.setdefault(repr((method.name, sorted(method.knobs().items(), key=lambda knob: knob[0]))), index)
            if first != index:
                raise ValueError(f"Study.methods[{index}] is the same as methods[{first}]: {method!r}")

    def _check_cameras(self) -> None:
        first: dict[str, int] = {}
        for index, scene in enumerate(self.scenes):
            if first.setdefault(scene.hash, index) != index:
                raise ValueError(f"Study.scenes[{index}] is the same as scenes[{first[scene.hash]}]; one scene may have several cameras")
            if not scene.cameras:
                raise ValueError(f"Study.scenes[{index}] ({scene.name!r}) has no camera")
        if self.cameras is None:
            return
        if isinstance(self.cameras, str):
            raise ValueError(f"Study.cameras must be a sequence of names or None, got {self.cameras!r}")
        _set(self, "cameras", tuple(self.cameras))
        known = sorted({name for scene in self.scenes for name in scene.cameras})
        for name in self.cameras:
            if name not in known:
                raise ValueError(f"Study.cameras: no scene has a camera {name!r}; there are {known}")
        for index, scene in enumerate(self.scenes):
            if not any(name in scene.cameras for name in self.cameras):
                raise ValueError(f"Study.scenes[{index}] ({scene.name!r}) has none of the cameras {list(self.cameras)}")

    def _repr_html_(self) -> str:
        from interreflect import display

        return display.study(self)

    def cells(self) -> list[Cell]:
        """Every cell, in the order of the table: scene, camera, method, seed."""
        return [
            Cell(scene, camera, method, seed, method.bounces if self.bounces == "method" else self.bounces)
            for scene in self.scenes
            for camera in self._cameras_of(scene)
            for method, seed in itertools.product(self.methods, self.seeds)
        ]

    def _cameras_of(self, scene: Scene) -> list[str]:
        if self.cameras is None:
            return [next(iter(scene.cameras))]
        return [name for name in self.cameras if name in scene.cameras]


def sweep(method: Any, axes: Mapping[str, Sequence[Any]]) -> list[Any]:
    """A method (or its class, with default knobs) at every combination of knob values; the last axis runs fastest.

    axes: knob path -> values, e.g. {"grid.resolution": [32, 64], "prefilter": [VolumeCoverage(), SurfaceCoverage()]}.
    TypeError for an unknown knob, ValueError for an axis without values or a value out of range.
    """
    base = method() if isinstance(method, type) else method
    for path, values in axes.items():
        if isinstance(values, str | bytes | Mapping) or not hasattr(values, "__iter__") or not list(values):
            raise ValueError(f"sweep: the axis {path!r} must be a sequence with at least one value, got {values!r}")
    return [base.replace(dict(zip(axes, values, strict=True))) for values in itertools.product(*(list(v) for v in axes.values()))]


def _sequence(field: str, value: Any) -> tuple[Any, ...]:
    if isinstance(value, str | bytes | Mapping) or not hasattr(value, "__iter__"):
        raise ValueError(f"Study.{field} must be a sequence, got {value!r}")
    items = tuple(value)
    if not items:
        raise ValueError(f"Study.{field} must not be empty")
    return items


def _whole(field: str, value: Any, least: int) -> int:
    if not isinstance(value, numbers.Integral) or isinstance(value, bool) or value < least:
        raise ValueError(f"Study.{field} must be whole, at least {least}, got {value!r}")
    return int(value)


def _set(study: Study, field: str, value: Any) -> None:
    object.__setattr__(study, field, value)
