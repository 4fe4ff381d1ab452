"""A method made ready for one scene: what is built once, and the rendering of frames from it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from interreflect import _core
from interreflect.frame import Frame
from interreflect.methods import stored
from interreflect.motion import Motion
from interreflect.profile import Profile
from interreflect.scenes.camera import Camera, checked_size
from interreflect.scenes.scene import Scene
from interreflect.stages import camera_of

if TYPE_CHECKING:
    from interreflect.methods.method import Method


@dataclass(frozen=True)
class View:
    """One frame to make: what a method's `compose` gets."""

    scene: Scene
    camera: Camera
    size: tuple[int, int]  # (width, height)
    seed: int
    state: dict[str, Any]
    history: Any = None


@dataclass(frozen=True, eq=False)
class Prepared:
    """precompute_milliseconds: wall time of building the hierarchy and whatever the method precomputes."""

    method: Method
    scene: Scene
    precompute_milliseconds: float
    state: dict[str, Any] = field(default_factory=dict, repr=False)
    threads: int | None = None

    def render(
        self,
        camera: Camera | str | None = None,
        size: tuple[int, int] | None = None,
        seed: int = 0,
        threads: int | None = None,
        scene: Scene | None = None,
        history: Any = None,
        profile: Profile | None = None,
    ) -> Frame:
        """The next frame. scene: the same scene with moved bodies or other lights, for IlluminanceComposition also with other emission.
        history: the last frame's. profile: to be filled, one that also keeps what stages make; None: a plain one.

        ValueError for a scene of other geometry or materials, an unknown camera, a size or seed out of range.
        """
        shown = self.scene if scene is None else scene
        if not self.method.shows(shown, self.scene):
            raise ValueError("render(scene=...) takes the prepared scene with moved bodies, other lights or cameras, not another one")
        if not 0 <= seed < 2**32:
            raise ValueError(f"seed must lie in [0, 2^32), got {seed}")
        place = camera_of(shown, camera)
        view = View(shown, place, place.size if size is None else checked_size(size), seed, self.state, history)
        profile = Profile() if profile is None else profile
        profile.precompute_milliseconds = self.precompute_milliseconds
        with _core.Threads(threads if threads is not None else self.threads):
            _ = shown.core  # a scene that was never rendered builds its hierarchy outside the frame's clock
            with profile.frame():
                direct, indirect, *kept = self.method.compose(view, profile)
        return Frame(direct, indirect, profile, *kept)

    def play(self, motion: Motion, size: tuple[int, int] | None = None, seed: int = 0, threads: int | None = None) -> Iterator[Frame]:
        """The frames of a motion, one after the other; each gets the last one's history, and frame k the seed `seed` + k.

        ValueError where the scene lacks the motion's camera, light or body.
        """
        history = None
        for k in range(motion.frames):
            scene, camera = motion.at(self.scene, k)
            frame = self.render(camera, size=size, seed=(seed + k) % 2**32, threads=threads, scene=scene, history=history)
            history = frame.history
            yield frame

    def save(self, path: str | Path) -> None:
        """Writes what was precomputed, with the geometry, materials and knobs it belongs to; a method makes what else it keeps anew."""
        belongs = {
            "method": type(self.method).__name__, "knobs": self.method.precomputed_by, "scene": self.scene.still_hash,
            "milliseconds": self.precompute_milliseconds,
        }  # fmt: skip
        stored.write(Path(path), belongs, self.method.to_store(self.state))

    @staticmethod
    def load(path: str | Path, method: Method, scene: Scene) -> Prepared:
        """What `save` wrote. ValueError where it is damaged, or belongs to other geometry, materials or knobs."""
        belongs, values = stored.read(Path(path))
        if belongs["scene"] != scene.still_hash:
            raise ValueError(f"{path}: made from another scene, or one with other materials than {scene.name!r}")
        if (belongs["method"], belongs["knobs"]) != (type(method).__name__, method.precomputed_by):
            raise ValueError(f"{path}: made by {belongs['method']} with {belongs['knobs']}, not with {method.precomputed_by}")
        try:
            state = method.from_store(values, scene)
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from error
        return Prepared(method=method, scene=scene, precompute_milliseconds=belongs["milliseconds"], state=state)
