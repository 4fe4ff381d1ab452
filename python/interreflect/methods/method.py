"""What every method is: a frozen value of techniques and knobs that prepares a scene and renders frames of it."""

from __future__ import annotations

import dataclasses
import functools
import re
import time
from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, ClassVar, TypeVar, dataclass_transform

import numpy as np

from interreflect import _core
from interreflect.frame import Frame, Image
from interreflect.methods.knobs import check_knob, flatten, is_technique, knob, no_preset, replace_in, stage, unknown
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import Prepared, View
from interreflect.profile import Profile
from interreflect.scenes.camera import Camera
from interreflect.scenes.scene import Scene

Self = TypeVar("Self", bound="Method")


@dataclass_transform(kw_only_default=True, frozen_default=True, field_specifiers=(knob, stage))
def method(cls: type[Self]) -> type[Self]:
    """Makes a class a method: a frozen, keyword-only dataclass whose unknown knobs are a TypeError with the nearest name."""
    made = dataclasses.dataclass(frozen=True, kw_only=True)(cls)
    plain = made.__init__
    names = [field.name for field in dataclasses.fields(made)]  # type: ignore[arg-type]

    @functools.wraps(plain)
    def __init__(self: Self, *wrong: Any, **given: Any) -> None:
        if wrong:
            raise TypeError(f"{cls.__name__} takes its knobs by keyword")
        for name in given:
            if name not in names:
                raise unknown(cls.__name__, name, names)
        plain(self, **given)

    made.__init__ = __init__  # type: ignore[method-assign, assignment]
    made.presets = tuple(made.preset_values)
    return made


class Method(ABC):
    """A composition of stages. Subclasses are made by `@method`, fields are knobs; `bounces` is the transport they aim at."""

    own_stages: ClassVar[tuple[str, ...]] = ()  # stages of the profile that no technique makes, but that `exactly` makes exact

    preset_values: ClassVar[Mapping[str, Mapping[str, Any]]] = {}  # name -> the knobs, by field, that differ from the defaults
    presets: ClassVar[tuple[str, ...]] = ()  # their names

    @classmethod
    def preset(cls: type[Self], name: str) -> Self:
        """A paper's configuration by its name, one of `presets`: a value like any other. ValueError for another, with the nearest."""
        if name not in cls.preset_values:
            raise no_preset(cls.__name__, name, cls.presets)
        return cls(**cls.preset_values[name])

    @property
    def bounces(self) -> int | None:
        """Most indirect bounces that the method's picture holds; None: all. A constant of the class, or a knob."""
        raise NotImplementedError(f"{type(self).__name__} must say how many bounces it renders")

    def __post_init__(self) -> None:
        for field in dataclasses.fields(self):  # type: ignore[arg-type]
            check_knob(type(self).__name__, field, getattr(self, field.name))

    @property
    def name(self) -> str:
        """The class's name in kebab case."""
        return re.sub(r"(?<!^)(?=[A-Z])", "-", type(self).__name__).lower()

    def knobs(self) -> dict[str, Any]:
        """Dotted path -> value of every knob; a technique's own path holds its name."""
        return dict(flatten({field.name: getattr(self, field.name) for field in dataclasses.fields(self)}))  # type: ignore[arg-type]

    def replace(self: Self, changes: Mapping[str, Any] | None = None, **more: Any) -> Self:
        """The same method with knobs replaced by dotted path. TypeError for an unknown path, with the nearest one."""
        changed: Self = self
        for path, value in {**(changes or {}), **more}.items():
            head, _, rest = path.partition(".")
            if head not in {field.name for field in dataclasses.fields(self)}:  # type: ignore[arg-type]
                raise unknown(type(self).__name__, path, list(self.knobs()))
            if rest:
                value = replace_in(getattr(changed, head), rest, value, type(self).__name__, path)
            changed = dataclasses.replace(changed, **{head: value})  # type: ignore[type-var]
        return changed

    def prepare(self, scene: Scene, threads: int | None = None, pieces: Pieces | None = None) -> Prepared:
        """Builds what does not belong to a frame: ray hierarchy, texture levels, and what the method precomputes.

        pieces: what methods prepared before this one have made of the same scene; it takes what it needs of them and leaves its own."""
        kept = Pieces(keeps=False) if pieces is None else pieces
        kept.begin((scene.still_hash, threads))
        with _core.Threads(threads):
            hierarchy = scene.core_milliseconds
            start = time.perf_counter()
            state = self.precompute(scene, kept)
            spent = 1e3 * (time.perf_counter() - start) + kept.saved_milliseconds
        return Prepared(method=self, scene=scene, state=state, precompute_milliseconds=hierarchy + spent, threads=threads)

    def load(self, path: str | Path, scene: Scene) -> Prepared:
        """What `Prepared.save` wrote. ValueError where it was made from other geometry, materials or knobs."""
        return Prepared.load(path, self, scene)

    def render(
        self,
        scene: Scene,
        camera: Camera | str | None = None,
        size: tuple[int, int] | None = None,
        seed: int = 0,
        threads: int | None = None,
    ) -> Frame:
        """One frame: `prepare` and `Prepared.render` in one call. size: (width, height), None: the camera's. threads: None: all."""
        return self.prepare(scene, threads).render(camera, size=size, seed=seed, threads=threads)

    def precompute(self, scene: Scene, pieces: Pieces) -> dict[str, Any]:
        """What is built once per geometry and materials, by name; nothing unless a method says so. Parts that other methods may share
        are made by `pieces.take`."""
        return {}

    def shows(self, scene: Scene, prepared: Scene) -> bool:
        """Whether what was precomputed for one scene holds for the other."""
        return scene is prepared or scene.still_hash == prepared.still_hash

    @property
    def pieces_key(self) -> tuple[Any, ...]:
        """What the pieces of its precomputation depend on, those that all others build on first; (): it shares none. A study
        measures methods side by side whose keys begin alike."""
        return ()

    @property
    def precomputed_by(self) -> str:
        """All knobs that what `precompute` makes depends on, in words."""
        return repr(self)

    def to_store(self, state: Mapping[str, Any]) -> dict[str, Any]:
        """The arrays and numbers of the state to keep in a file; what else there is, `from_store` or the frames make anew."""
        return {name: value for name, value in state.items() if isinstance(value, np.ndarray)}

    def from_store(self, stored: dict[str, Any], scene: Scene) -> dict[str, Any]:
        """The state out of what `to_store` kept. ValueError where that is not sound."""
        return stored

    @abstractmethod
    def compose(self, view: View, profile: Profile) -> tuple[Image, Image] | tuple[Image, Image, Any]:
        """Direct and indirect light of one view: the stages in order, each under `profile.stage(name)`.

        A method with memory gives its history as a third; the next frame finds it in `view.history`, None in the first.
        """

    def exactly(self, stages: Collection[str], samples: int) -> Method:
        """What renders as this method does but for some of its `own_stages`, which are exact; random ones take at least `samples`."""
        return self

    def _repr_html_(self) -> str:
        from interreflect import display

        return display.method(self)

    def exact_knobs(self) -> dict[str, Any]:
        """Field -> technique for every field that holds a technique (what may be replaced by its exact counterpart)."""
        values = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}  # type: ignore[arg-type]
        return {name: value for name, value in values.items() if is_technique(value)}
