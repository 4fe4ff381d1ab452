"""The profile of one frame: wall time, memory and work counts of each stage, in order."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeVar

Result = TypeVar("Result")


@dataclass(frozen=True)
class Stage:
    """milliseconds: wall time. bytes: memory that the stage's result holds. counts: work done, name -> number."""

    milliseconds: float
    bytes: int = 0
    counts: dict[str, int] = field(default_factory=dict)


class StageClock:
    """What `with profile.stage(name) as stage` hands out; `stage(result)` notes the result's bytes and counts and returns it."""

    def __init__(self) -> None:
        self.bytes = 0
        self.counts: dict[str, int] = {}

    def __call__(self, result: Result) -> Result:
        self.bytes += int(getattr(result, "bytes", 0))
        counts: Any = getattr(result, "counts", None)
        for name, count in (counts.asdict() if counts is not None else {}).items():
            self.counts[name] = self.counts.get(name, 0) + count
        return result


class Profile:
    """Filled by a method while it makes a frame: `with profile.stage("voxelize") as stage: voxels = stage(voxelize(...))`."""

    def __init__(self) -> None:
        self.stages: dict[str, Stage] = {}
        self.milliseconds = 0.0  # wall time of the frame
        self.precompute_milliseconds = 0.0

    def clock(self, name: str) -> StageClock:
        """What `stage(name)` hands out; a profile that keeps what stages make hands out another."""
        return StageClock()

    @contextmanager
    def stage(self, name: str) -> Iterator[StageClock]:
        """Times one stage; a name used twice adds up."""
        clock = self.clock(name)
        start = time.perf_counter()
        yield clock
        spent = 1e3 * (time.perf_counter() - start)
        before = self.stages.get(name, Stage(0.0))
        counts = {key: before.counts.get(key, 0) + clock.counts.get(key, 0) for key in {**before.counts, **clock.counts}}
        self.stages[name] = Stage(before.milliseconds + spent, before.bytes + clock.bytes, counts)

    @contextmanager
    def frame(self) -> Iterator[None]:
        """Times the whole frame."""
        start = time.perf_counter()
        yield
        self.milliseconds = 1e3 * (time.perf_counter() - start)

    def __repr__(self) -> str:
        rows = [f"  {name:<16} {stage.milliseconds:9.2f} ms {stage.bytes / 2**20:8.1f} MiB" for name, stage in self.stages.items()]
        head = f"Profile: frame {self.milliseconds:.2f} ms, precomputation {self.precompute_milliseconds:.2f} ms"
        return "\n".join([head, *rows])

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{name}</td><td>{stage.milliseconds:.2f}</td><td>{stage.bytes / 2**20:.1f}</td>"
            f"<td>{', '.join(f'{count:,} {what}' for what, count in stage.counts.items())}</td></tr>"
            for name, stage in self.stages.items()
        )
        head = "<tr><th>stage</th><th>ms</th><th>MiB</th><th>work</th></tr>"
        return f"<table>{head}{rows}<tr><td>frame</td><td>{self.milliseconds:.2f}</td><td></td><td></td></tr></table>"
