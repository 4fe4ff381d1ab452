"""Scenes and methods whose truth, error and time are known exactly, of the shape that the study layer measures."""

from __future__ import annotations

import dataclasses
import hashlib
import os
import signal
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np

import interreflect.study.contention as contention
import interreflect.study.reference as reference_module
import interreflect.study.timing as timing


@dataclasses.dataclass(frozen=True)
class Camera:
    position: tuple = (0.0, 0.0, 1.0)


@dataclasses.dataclass(frozen=True, eq=False)
class Scene:
    name: str = "plain"
    level: float = 1.0  # the truth's mean radiance
    cameras: dict = dataclasses.field(default_factory=lambda: {"front": Camera()})
    warnings: tuple = ()

    @property
    def hash(self):
        return hashlib.sha256(f"{self.level}".encode()).hexdigest()


def truth_of(scene, size):
    """Direct and indirect light: a ramp of mean `level`, three quarters of it direct."""
    ramp = np.linspace(0.5, 1.5, size[0] * size[1] * 3).reshape(size[1], size[0], 3) * scene.level
    return (ramp * 0.75).astype(np.float32), (ramp * 0.25).astype(np.float32)


def frame(direct, indirect, milliseconds=1.0):
    stages = {
        "march": SimpleNamespace(milliseconds=milliseconds * 0.75, bytes=64, counts={"rays": 10}),
        "shade": SimpleNamespace(milliseconds=milliseconds * 0.25, bytes=0, counts={}),
    }
    profile = SimpleNamespace(stages=stages, milliseconds=milliseconds)
    return SimpleNamespace(image=direct + indirect, direct=direct, indirect=indirect, profile=profile)


@dataclasses.dataclass(frozen=True)
class Fake:
    """Adds the relative error `error` to the indirect light, in `milliseconds`; may raise or give NaN."""

    error: float = 0.1
    time: float = 1.0
    mode: str = "ok"
    bounces: int | None = 1

    @property
    def name(self):
        return "fake"

    def knobs(self):
        return {"error": self.error, "time": self.time, "mode": self.mode}

    def replace(self, knobs):
        unknown = set(knobs) - {"error", "time", "mode", "bounces"}
        if unknown:
            raise TypeError(f"Fake has no knob {sorted(unknown)}")
        return dataclasses.replace(self, **knobs)

    def prepare(self, scene, threads=None):
        if self.mode == "unprepared":
            raise RuntimeError("no room")
        return FakePrepared(self, scene)


@dataclasses.dataclass(frozen=True)
class FakePrepared:
    method: Fake
    scene: Scene
    precompute_milliseconds: float = 7.0

    def render(self, camera=None, size=None, seed=0, threads=None):
        note_render()
        if self.method.mode in DEEDS:
            DEEDS[self.method.mode]()
        if self.method.mode == "raises":
            raise RuntimeError("lamp broken")
        direct, indirect = truth_of(self.scene, size)
        indirect = indirect * np.float32(1 + self.method.error * (1 + 0.01 * seed))
        if self.method.mode == "nan":
            indirect[0, 0, 0] = np.nan
        if self.method.mode == "small":
            direct, indirect = direct[1:], indirect[1:]
        return frame(direct, indirect, self.method.time)


@dataclasses.dataclass(frozen=True)
class FakePathTracing:
    """Unbiased: the truth times noise of variance 1/spp."""

    spp: int = 1
    bounces: int | None = 1
    pixel: str = "centre"
    deviation: float = 0.1

    def prepare(self, scene, threads=None):
        return FakePathTraced(self, scene)


@dataclasses.dataclass(frozen=True)
class FakePathTraced:
    method: FakePathTracing
    scene: Scene

    def render(self, camera=None, size=None, seed=0, threads=None):
        direct, indirect = truth_of(self.scene, size)
        noise = np.random.default_rng(seed).normal(1, self.method.deviation / np.sqrt(self.method.spp), direct.shape)
        return frame(direct, (indirect * noise).astype(np.float32))


def lasting(table):
    """The columns that are the same however often a study with fakes, whose times are given, is run."""
    return table.drop(columns=["peak_memory_bytes", "calibration", "limit_milliseconds", "limit_ratio"])


TRUTH = "STUDY_FAKES_TRUTH"  # set: truths by FakePathTracing, in every process that imports this file


class QuietWatch(contention.Watch):
    """On a machine that does nothing else, as far as tests with fakes are concerned."""

    def contention(self):
        return contention.Contention(0.0, False) if TRUTH in os.environ else super().contention()


timing.Watch = QuietWatch
real_path_tracer = reference_module.path_tracer
reference_module.path_tracer = lambda: FakePathTracing if TRUTH in os.environ else real_path_tracer()


def use_fake_truth(folder):
    """Let truths come from FakePathTracing and be cached below `folder`, in this process and its workers."""
    os.environ[TRUTH] = "1"
    os.environ["INTERREFLECT_CACHE"] = str(folder)


def note_render():
    """A byte for every render of any fake in any process, where a test wants to count them."""
    if "STUDY_FAKES_RENDERS" in os.environ:
        with open(os.environ["STUDY_FAKES_RENDERS"], "ab") as file:
            file.write(b".")


def eat_memory():
    eaten = [np.ones(2**24, np.uint8) for _ in range(64)]  # 1 GiB
    time.sleep(60)
    return eaten


def eat_memory_briefly():
    np.ones(2**28, np.uint8)


def take_time():
    """A while, noted with its begin and end."""
    begin = time.monotonic()
    time.sleep(0.2)
    if "STUDY_FAKES_SPANS" in os.environ:
        with open(os.environ["STUDY_FAKES_SPANS"], "a") as file:
            file.write(f"{begin} {time.monotonic()}\n")


def meet():
    """Until another render waits here too, 20 s at most: RuntimeError where none comes."""
    folder, end = Path(os.environ["STUDY_FAKES_MEETING"]), time.monotonic() + 20
    (folder / str(os.getpid())).touch()
    while len(list(folder.iterdir())) < 2:
        if time.monotonic() > end:
            raise RuntimeError("nobody came")
        time.sleep(0.01)


DEEDS = {
    "crashes": lambda: os.kill(os.getpid(), signal.SIGSEGV),
    "is killed": lambda: os.kill(os.getpid(), signal.SIGKILL),
    "leaves": lambda: os._exit(3),
    "hangs": lambda: time.sleep(600),
    "eats memory": eat_memory,
    "eats memory briefly": eat_memory_briefly,
    "takes its time": take_time,
    "meets another": meet,
    "prints": lambda: print("a word from a method"),
}
