"""A frame together with what its stages made, as far as someone wants to look at it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, TypeVar

from interreflect.frame import Frame
from interreflect.methods.prepared import Prepared
from interreflect.profile import Profile, StageClock
from interreflect.scenes.camera import Camera

Result = TypeVar("Result")


class WatchedProfile(Profile):
    """A profile that keeps the results of some stages, in order."""

    def __init__(self, stages: Collection[str]) -> None:
        super().__init__()
        self.results: dict[str, list[Any]] = {name: [] for name in stages}

    def clock(self, name: str) -> StageClock:
        return _Watch(self.results[name]) if name in self.results else StageClock()


class _Watch(StageClock):
    def __init__(self, kept: list[Any]) -> None:
        super().__init__()
        self.kept = kept

    def __call__(self, result: Result) -> Result:
        self.kept.append(result)
        return super().__call__(result)


@dataclass(frozen=True, eq=False)
class Seen:
    """results: of the stages that were watched, by the stage's name."""

    frame: Frame
    prepared: Prepared
    camera: Camera
    size: tuple[int, int]
    results: dict[str, list[Any]]

    def first(self, *stages: str) -> Any:
        """The first result of the first of these stages that made one; None where none did."""
        return next((self.results[name][0] for name in stages if self.results.get(name)), None)


def see(prepared: Prepared, camera: Camera, size: tuple[int, int], seed: int, history: Any, stages: Collection[str]) -> Seen:
    """Renders a frame and keeps what `stages` make."""
    profile = WatchedProfile(stages)
    frame = prepared.render(camera, size=size, seed=seed, history=history, profile=profile)
    return Seen(frame, prepared, camera, size, profile.results)
