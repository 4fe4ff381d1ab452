"""What must not change a picture: scale, place, direction and unit of light, threads; and what must not make it worse: finer settings."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from interreflect import metrics
from interreflect.motion import dimmed
from interreflect.scenes.scene import Scene
from interreflect.stability.crossing import STUDENT
from interreflect.stability.similar import similar
from interreflect.study.reference import Reference, reference

if TYPE_CHECKING:
    import pandas as pd

Floats = NDArray[np.float64]
BLOCK = 12  # pixels along a side of the blocks whose means are compared where noise differs
SIGMAS = 3.0
REFINES = ("resolution", "samples", "spp", "cones", "size")  # knobs whose growth must not raise the error
TRUTH = Reference(noise=3e-4, max_spp=1024)
BRIGHTER = 4.0  # a power of two: exact in floats


@dataclasses.dataclass(frozen=True)
class Check:
    """change: how much the picture (or its error) changed; noise: what seeds alone explain; bound: what is allowed beyond that, and why."""

    name: str
    change: float
    noise: float
    bound: float
    reason: str
    holds: bool


@dataclasses.dataclass(frozen=True, eq=False)
class Invariance:
    """The checks of one method."""

    method: str
    scene: str
    checks: tuple[Check, ...]

    @property
    def holds(self) -> bool:
        return all(check.holds for check in self.checks)

    @property
    def broken(self) -> tuple[Check, ...]:
        return tuple(check for check in self.checks if not check.holds)

    @cached_property
    def table(self) -> pd.DataFrame:
        import pandas as pd

        return pd.DataFrame([dataclasses.asdict(check) for check in self.checks]).set_index("name")

    def __repr__(self) -> str:
        words = ", ".join(f"{check.name} ({check.change:.3g} > {check.bound:g})" for check in self.broken) or "all hold"
        return f"<{self.method} on {self.scene}: {len(self.checks)} invariants, {words}>"

    def _repr_html_(self) -> str:
        return str(self.table.to_html(float_format=lambda number: f"{number:.3g}"))


def invariance(
    method: Any, scene: Scene | None = None, camera: str | None = None, size: tuple[int, int] = (96, 72), seeds: Iterable[int] = range(4)
) -> Invariance:
    """Renders a scene changed in ways that must not matter, and at coarser and finer settings, and compares.

    scene: None: the Cornell box with a point light. Its light must not be that of an image that the changes would resample.
    seeds: at least two; noise is told from change by them. ValueError for fewer.
    """
    from interreflect import scenes

    numbers = tuple(seeds)
    if len(numbers) < 2:
        raise ValueError(f"invariance needs at least two seeds to tell noise from change, got {numbers}")
    shown = scenes.cornell_box("point") if scene is None else scene
    bench = _Bench(method, shown, camera, size, numbers)
    checks = [*_same_picture(bench), _turned(bench), _linear(bench), _dark(bench), _threads(bench), *_finer(bench)]
    return Invariance(method.name, shown.name, tuple(checks))


@dataclasses.dataclass(frozen=True)
class _Bench:
    method: Any
    scene: Scene
    camera: str | None
    size: tuple[int, int]
    seeds: Sequence[int]

    def picture(self, scene: Scene, seed: int, threads: int | None = None, method: Any = None) -> Floats:
        frame = (method or self.method).render(scene, self.camera, size=self.size, seed=seed, threads=threads)
        return np.asarray(frame.image, np.float64)

    def pictures(self, scene: Scene) -> Floats:
        return np.stack([self.picture(scene, seed) for seed in self.seeds])


def _same_picture(bench: _Bench) -> list[Check]:
    """Same seed, same picture, but for what rounding moves across the border of a voxel or past an edge."""
    extent = float(np.ptp(bench.scene.bounds, axis=0).max())
    before = bench.picture(bench.scene, bench.seeds[0])
    reason = "rounding moves surfaces across the borders of voxels and rays past edges: a pixel in a hundred"
    changes: dict[str, dict[str, Any]] = {
        "scene times 1e-3": {"scale": 1e-3},
        "scene times 1e3": {"scale": 1e3},
        "scene moved by 100 extents": {"shift": np.multiply(100 * extent, (0.6, -0.48, 0.64))},
    }
    checks = []
    for name, change in changes.items():
        after = bench.picture(similar(bench.scene, **change), bench.seeds[0])
        difference = float(np.abs(after - before).mean() / before.mean())
        checks.append(Check(name, difference, 0.0, 0.01, reason, difference <= 0.01))
    return checks


def _turned(bench: _Bench) -> Check:
    """A quarter turn about up: voxels turn along, but frames about normals do not, so random numbers meet other directions."""
    before, after = bench.pictures(bench.scene), bench.pictures(similar(bench.scene, turn=90.0))
    change, noise = _block_change(before, after)
    reason = "cones stand at other azimuths about their normals, and interleaved pixels at edges have but some of them"
    return Check("scene turned by 90 degrees", change, noise, 0.05, reason, change <= np.hypot(0.05, SIGMAS * noise))


def _block_change(before: Floats, after: Floats) -> tuple[float, float]:
    """Root mean square difference of block means over the picture's mean, (seeds, height, width, 3) each; and what seeds explain of it."""
    a, b = _blocks(before), _blocks(after)
    scale = float(before.mean())
    change = np.sqrt(((a.mean(0) - b.mean(0)) ** 2).mean()) / scale
    noise = np.sqrt((a.var(0, ddof=1) + b.var(0, ddof=1)).mean() / len(a)) / scale
    return float(change), float(noise)


def _blocks(pictures: Floats) -> Floats:
    seeds, height, width, channels = pictures.shape
    rows, columns = height // BLOCK, width // BLOCK
    cut = pictures[:, : rows * BLOCK, : columns * BLOCK]
    return np.asarray(cut.reshape(seeds, rows, BLOCK, columns, BLOCK, channels).mean((2, 4)))


def brighter(scene: Scene, factor: float) -> Scene:
    """The scene with all its light times `factor`."""
    emitting = {mesh.material.name: mesh.material for mesh in scene.meshes if mesh.material.emits}
    lit = scene.replace(lights=[dimmed(light, factor) for light in scene.lights])
    return lit.replace(materials={name: {"emission": tuple(factor * e for e in m.emission)} for name, m in emitting.items()})


def _linear(bench: _Bench) -> Check:
    once = bench.picture(bench.scene, bench.seeds[0])
    more = bench.picture(brighter(bench.scene, BRIGHTER), bench.seeds[0]) / BRIGHTER
    change = float(np.abs(more - once).mean() / once.mean())
    reason = "half floats round to 5e-4, on several levels; a denoiser's exposure is rounded, too"
    return Check("four times the light", change, 0.0, 2e-3, reason, change <= 2e-3)


def _dark(bench: _Bench) -> Check:
    once = bench.picture(bench.scene, bench.seeds[0])
    black = bench.picture(brighter(bench.scene, 0.0), bench.seeds[0])
    change = float(np.abs(black).mean() / once.mean())
    return Check("no light", change, 0.0, 1e-4, "none is made; a denoiser's black is not quite 0", change <= 1e-4)


def _threads(bench: _Bench) -> Check:
    one, two = (bench.picture(bench.scene, bench.seeds[0], threads) for threads in (1, 2))
    change = float(np.abs(one - two).max())
    return Check("one and two threads", change, 0.0, 0.0, "same seed, same bits", change == 0)


def _finer(bench: _Bench) -> list[Check]:
    """For each knob that refines: relMSE at a quarter, half and all of it (or once, twice and four times small ones)."""
    truth = reference(bench.scene, bench.camera, bench.size, bench.method.bounces, TRUTH.noise, TRUTH.max_spp)
    checks = []
    for path, value in bench.method.knobs().items():
        if path.rpartition(".")[2] not in REFINES or not isinstance(value, int) or isinstance(value, bool):
            continue
        values = [value // 4, value // 2, value] if value >= 16 else [value, 2 * value, 4 * value]
        errors = [_errors(bench, bench.method.replace({path: v}), lambda image: metrics.relmse(image, truth.image)) for v in values]
        checks.append(_not_rising(path, values, errors, truth.noise))
    return checks


def _errors(bench: _Bench, method: Any, error: Callable[[Floats], float]) -> Floats:
    return np.array([error(bench.picture(bench.scene, seed, method=method)) for seed in bench.seeds])


def _not_rising(path: str, values: Sequence[int], errors: Sequence[Floats], floor: float) -> Check:
    """Does the error rise from any setting to the next finer one by more than noise? The step that rises most beyond it is told."""
    student = STUDENT.get(len(errors[0]), 2.0)
    steps = []
    for coarse, fine in itertools.pairwise(errors):
        spread = student * float(np.sqrt((coarse.var(ddof=1) + fine.var(ddof=1)) / len(coarse)))
        steps.append((float(fine.mean() - coarse.mean()), spread + floor))
    rise, noise = max(steps, key=lambda step: step[0] - step[1])
    scale = float(max(error.mean() for error in errors)) or 1.0
    reason = f"relMSE {', '.join(f'{error.mean():.3g}' for error in errors)} at {', '.join(map(str, values))}"
    return Check(f"finer {path}", rise / scale, noise / scale, 0.0, reason, rise <= noise)
