"""Scenes and methods whose truth, error and time are known exactly, of the shape that the study layer measures."""

from __future__ import annotations

import dataclasses
import hashlib
import itertools
import os
from types import SimpleNamespace

import numpy as np

import interreflect.study.reference as reference_module


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
    renders = itertools.count()  # of all fakes, to see what a resumed study renders again

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
        next(Fake.renders)
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


def use_fake_truth(folder):
    """Let truths come from FakePathTracing and be cached below `folder`, in a process that does nothing else."""
    reference_module.path_tracer = lambda: FakePathTracing
    os.environ["INTERREFLECT_CACHE"] = str(folder)
