"""What a study and its worker processes say to each other: pickles and their arrays through pipes, with their lengths before them."""

from __future__ import annotations

import dataclasses
import pickle
import struct
from typing import IO, Any

from interreflect.study.calibration import Calibration
from interreflect.study.interface import Image
from interreflect.study.reference import Reference

LENGTH = struct.Struct("<Q")
Pair = tuple[Image, Image]  # image, indirect light


@dataclasses.dataclass(frozen=True)
class Surroundings:
    """The parent's, when a study begins. Answered by Ready."""

    path: list[str]
    environment: dict[str, str]
    folder: str


@dataclasses.dataclass(frozen=True)
class Ready:
    """fresh: are the files of all modules that the worker loaded as they were? idle: bytes that it holds without any scene."""

    fresh: bool
    idle: int


@dataclasses.dataclass(frozen=True)
class Request:
    """One cell to measure. Answered by phases, as they begin, its pictures where they are kept, and then by a Reply."""

    scene_key: str  # of its content and its cameras
    camera: str
    method: bytes  # pickled
    seed: int
    size: tuple[int, int]
    bounces: int | None
    reference: Reference
    threads: int | None
    repeats: int
    max_repeats: int
    images: bool
    truth: str  # its key
    truth_wanted: bool  # its pictures too, as the folder lacks them
    code: str  # digest of the parent's package: another one must not measure
    scene: bytes | None = None  # pickled; None: the worker holds it
    calibration: Calibration | None = None  # of this machine, where an earlier worker of the study made it


@dataclasses.dataclass(frozen=True)
class Phase:
    """What the worker begins to do ("truth", "calibrate", "prepare", "render", "metrics"), or awaits: its "turn", the parent's "go"
    before it renders on. detail: how far it is, in words."""

    name: str
    detail: str = ""


@dataclasses.dataclass(frozen=True, eq=False)
class Pictures:
    """Image and indirect light of a cell, and those of its truth under its key where they are wanted; on their way before the metrics."""

    cell: Pair
    truth: tuple[str, Pair] | None = None


@dataclasses.dataclass(frozen=True)
class Go:
    """The parent does nothing that disturbs a clock: the worker may start it."""


@dataclasses.dataclass(frozen=True)
class Reply:
    """changes: fields of the cell's record. calibration: of the machine that timed the cell."""

    changes: dict[str, Any]
    calibration: Calibration | None = None
    interrupted: bool = False
    refused: str = ""  # why nothing can be measured there at all


def send(stream: IO[bytes], message: object) -> None:
    """Write a message whole, arrays as they lie in memory. BrokenPipeError where nobody reads any more."""
    arrays: list[pickle.PickleBuffer] = []
    parts = [memoryview(pickle.dumps(message, 5, buffer_callback=arrays.append)), *(array.raw() for array in arrays)]
    stream.write(b"".join(LENGTH.pack(number) for number in (len(parts), *(part.nbytes for part in parts))))
    for part in parts:
        stream.write(part)
    stream.flush()


def receive(stream: IO[bytes]) -> Any:
    """The next message. EOFError where the other side is gone."""
    (count,) = LENGTH.unpack(_exactly(stream, LENGTH.size))
    lengths = LENGTH.iter_unpack(_exactly(stream, count * LENGTH.size))
    data, *arrays = [_exactly(stream, length) for (length,) in lengths]
    return pickle.loads(data, buffers=arrays)


def _exactly(stream: IO[bytes], count: int) -> bytearray:
    """A stream without a buffer gives what is there, which may be less."""
    data = bytearray(count)
    view, filled = memoryview(data), 0
    while filled < count:
        read = stream.readinto(view[filled:])  # type: ignore[attr-defined]
        if not read:
            raise EOFError
        filled += read
    return data
