"""Truth: path tracing in two independent halves, whose difference tells how far the truth itself can be trusted."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import interreflect.cache as cache
from interreflect import metrics
from interreflect.progress import bar
from interreflect.scenes.camera import checked_size
from interreflect.study.files import canonical, set_aside
from interreflect.study.interface import Frame, Image, Scene
from interreflect.study.sources import source_digest

FORMAT = 1
SECONDS_AT_STAKE = 5.0  # of sampling, before a truth's halves are kept
FIRST_SPP = 8  # samples per pixel of each half's first round


@dataclasses.dataclass(frozen=True)
class Reference:
    """How good the truth must be: samples double until its own relMSE is at most `noise`, up to `max_spp`."""

    noise: float = 1e-3
    max_spp: int = 4096

    def __post_init__(self) -> None:
        if not (isinstance(self.noise, int | float) and math.isfinite(self.noise) and self.noise > 0):
            raise ValueError(f"Reference.noise must be above 0, got {self.noise!r}")
        if not isinstance(self.max_spp, int) or isinstance(self.max_spp, bool) or self.max_spp < 2:
            raise ValueError(f"Reference.max_spp must be at least 2 (two halves), got {self.max_spp!r}")


@dataclasses.dataclass(frozen=True, eq=False)
class Truth:
    """The mean of two independent halves. Arrays are float32, (height, width, 3), linear; image = direct + indirect."""

    image: Image
    direct: Image
    indirect: Image
    halves: tuple[Image, Image]
    noise: float  # mean((A - B)^2 / 4 / (truth^2 + eps)): the relMSE of `image`
    indirect_noise: float  # the same of `indirect`
    spp: int  # samples per pixel, both halves together
    key: str


def reference(
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (640, 360),
    bounces: int | None = None,
    noise: float = 1e-3,
    max_spp: int = 4096,
    seed: int = 0,
    threads: int | None = None,
) -> Truth:
    """The path-traced truth of a view, through pixel centres; kept on disk by content.

    camera: a name; None: the scene's first. size: (width, height). bounces: indirect bounces, None: all. noise: bound of the
    truth's own relMSE, as far as `max_spp` samples per pixel allow: see the result's `noise`. What was sampled before an
    interruption is not lost. ValueError for settings out of range and for a picture with numbers that are not finite.
    """
    wanted = Reference(noise, max_spp)
    name, size = camera_name(scene, camera), checked_size(size)
    key = reference_key(scene, name, size, bounces, wanted, seed)
    path = cache.folder("references") / f"{key}.npz"
    found = load_truth(path)
    if found is not None:
        cache.touch(path)
        return found
    method = path_tracer()

    def render(spp: int, seed: int) -> Frame:
        tracer = method(spp=spp, bounces=bounces, pixel="centre")
        return tracer.prepare(scene, threads=threads).render(name, size=size, seed=seed, threads=threads)  # type: ignore[no-any-return]

    halves = path.with_suffix(".halves.npz")
    with _Progress(wanted, halves) as progress:
        truth = converge(render, wanted, seed, key, load_halves(halves), progress)
    save_truth(truth, path)
    halves.unlink(missing_ok=True)
    return truth


def path_tracer() -> Any:
    """The method that makes truths."""
    from interreflect.methods import PathTracing

    return PathTracing


def camera_name(scene: Scene, camera: str | None) -> str:
    """The camera's name, the first for None. ValueError for a scene that lacks it."""
    if camera is None:
        if not scene.cameras:
            raise ValueError(f"the scene {scene.name!r} has no camera")
        return next(iter(scene.cameras))
    if camera not in scene.cameras:
        raise ValueError(f"the scene {scene.name!r} has no camera {camera!r}; it has {list(scene.cameras)}")
    return camera


def reference_key(scene: Scene, camera: str, size: tuple[int, int], bounces: int | None, wanted: Reference, seed: int) -> str:
    """Hash of everything that determines a truth; threads do not."""
    identity = {
        "format": FORMAT,
        "scene": scene.hash,
        "camera": dataclasses.asdict(scene.cameras[camera]),
        "size": list(size),
        "bounces": bounces,
        "reference": dataclasses.asdict(wanted),
        "seed": seed,
        "sources": source_digest(path_tracer(), Path(__file__)),
    }
    return hashlib.sha256(canonical(identity).encode()).hexdigest()[:32]


def converge(
    render: Callable[[int, int], Frame],
    wanted: Reference,
    seed: int,
    key: str = "",
    start: tuple[Half, Half] | None = None,
    after_round: Callable[[tuple[Half, Half], Truth], None] | None = None,
) -> Truth:
    """Double the samples of two halves until the noise bound or the largest number of samples is reached.

    render(spp, seed) gives an unbiased frame, independent for every seed. start: halves of an earlier call with the same
    arguments, after whole rounds; the result is the same to the bit.
    """
    largest = wanted.max_spp // 2
    halves = start or (Half(), Half())
    while True:
        spp = min(max(halves[0].spp, FIRST_SPP), largest - halves[0].spp)
        if spp > 0:
            for index, half in enumerate(halves):
                half.add(render(spp, stream_seed(seed, index, half.rounds)), spp)
        truth = merged(halves[0], halves[1], key)
        if after_round is not None:
            after_round(halves, truth)
        if truth.noise <= wanted.noise or halves[0].spp >= largest:
            return truth


@dataclasses.dataclass(eq=False)
class Half:
    """Running mean of direct and indirect light."""

    direct: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros(()))
    indirect: npt.NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros(()))
    spp: int = 0
    rounds: int = 0

    def add(self, frame: Frame, spp: int) -> None:
        for name in ("direct", "indirect"):
            wrong = int(np.size(getattr(frame, name)) - np.isfinite(getattr(frame, name)).sum())
            if wrong:
                raise ValueError(f"the truth's {name} light has {wrong} numbers that are not finite")
        share = spp / (self.spp + spp)
        self.direct = self.direct * (1 - share) + np.asarray(frame.direct, np.float64) * share
        self.indirect = self.indirect * (1 - share) + np.asarray(frame.indirect, np.float64) * share
        self.spp += spp
        self.rounds += 1


def stream_seed(seed: int, half: int, round: int) -> int:
    """A seed of 31 bits for one render; hashed, lest a study's own seeds 0, 1, 2 meet the truth's streams."""
    return int.from_bytes(hashlib.blake2b(f"reference {seed} {half} {round}".encode(), digest_size=4).digest()) >> 1


def merged(a: Half, b: Half, key: str) -> Truth:
    """The truth of two halves with as many samples each."""
    direct, indirect = (a.direct + b.direct) / 2, (a.indirect + b.indirect) / 2
    image_a, image_b = a.direct + a.indirect, b.direct + b.indirect
    return Truth(
        image=(direct + indirect).astype(np.float32),
        direct=direct.astype(np.float32),
        indirect=indirect.astype(np.float32),
        halves=(image_a.astype(np.float32), image_b.astype(np.float32)),
        noise=_noise(image_a, image_b),
        indirect_noise=_noise(a.indirect, b.indirect),
        spp=a.spp + b.spp,
        key=key,
    )


def _noise(a: npt.NDArray[np.float64], b: npt.NDArray[np.float64]) -> float:
    """The relMSE of the mean of two independent halves: its expected square error is that of half their difference."""
    return metrics.relmse(a, (a + b) / 2)


class _Progress:
    """Shows how far a truth is, and keeps its halves now and then, so that an interruption costs seconds and not the whole."""

    def __init__(self, wanted: Reference, path: Path) -> None:
        self.path, self.saved = path, time.monotonic()
        self.bar = bar(total=wanted.max_spp, desc="truth", unit="spp", leave=False, delay=1)

    def __call__(self, halves: tuple[Half, Half], truth: Truth) -> None:
        self.bar.update(truth.spp - self.bar.n)
        self.bar.set_postfix_str(f"noise {truth.noise:.1e}")
        if time.monotonic() - self.saved > SECONDS_AT_STAKE:
            save_halves(halves, self.path)
            self.saved = time.monotonic()

    def __enter__(self) -> _Progress:
        return self

    def __exit__(self, *_: object) -> None:
        self.bar.close()


def save_halves(halves: tuple[Half, Half], path: Path) -> None:
    """Keep two halves after a whole round, in double precision."""
    light = np.stack([[half.direct, half.indirect] for half in halves])
    numbers = np.array([halves[0].spp, halves[0].rounds])
    cache.write(path, lambda file: np.savez(file, allow_pickle=False, light=light, numbers=numbers))


def load_halves(path: Path) -> tuple[Half, Half] | None:
    """What `save_halves` kept; None where there is nothing, or it was damaged and is set aside."""
    found = _load_arrays(path, ("light", "numbers"))
    if found is None:
        return None
    spp, rounds = (int(number) for number in found["numbers"])
    a, b = (Half(direct, indirect, spp, rounds) for direct, indirect in found["light"])
    return a, b


def save_truth(truth: Truth, path: Path) -> None:
    """Keep a truth in the cache; without a cache that can be written it is made anew each time, which a warning says."""
    arrays = {"image": truth.image, "direct": truth.direct, "indirect": truth.indirect, "halves": np.stack(truth.halves)}
    numbers = np.array([truth.noise, truth.indirect_noise, truth.spp])
    cache.write(path, lambda file: np.savez(file, allow_pickle=False, **arrays, numbers=numbers))


def load_truth(path: Path) -> Truth | None:
    """A saved truth; None where there is none, or it was damaged and is set aside."""
    a = _load_arrays(path, ("image", "direct", "indirect", "halves", "numbers"))
    if a is None:
        return None
    noise, indirect_noise, spp = (float(x) for x in a["numbers"])
    halves = a["halves"][0], a["halves"][1]
    return Truth(a["image"], a["direct"], a["indirect"], halves, noise, indirect_noise, int(spp), path.stem)


def _load_arrays(path: Path, names: tuple[str, ...]) -> dict[str, Any] | None:
    try:
        with np.load(path, allow_pickle=False) as kept:
            return {name: kept[name] for name in names}
    except FileNotFoundError:
        return None
    except (ValueError, KeyError, OSError, EOFError, zipfile.BadZipFile):
        set_aside(path)
        return None
