"""The machine card: what ran, on what. Every record carries it, so that times and pictures can be told apart later."""

from __future__ import annotations

import dataclasses
import os
import platform
import re
import subprocess
from functools import cache
from html import escape
from importlib import metadata
from pathlib import Path
from typing import Any

# Libraries whose version can change a picture or a metric.
LIBRARIES = ("numpy", "OpenImageIO", "flip-evaluator", "scikit-image", "moocore", "pyoidn")
UNKNOWN = "unknown"


@dataclasses.dataclass(frozen=True)
class About:
    """Machine, build and versions. What cannot be found out is "unknown", never guessed."""

    version: str
    commit: str
    processor: str
    cores: int  # of the threads below; hyper-threads of one core count once
    threads: int
    vectors: str  # what the core's kernels run on: sse4, avx2 or avx512; the environment's INTERREFLECT_VECTORS forces one
    vector_bits: int  # of those vectors; 0: unknown
    memory_bytes: int
    system: str
    compiler: str
    build: dict[str, Any]  # what the compiled core says about itself, as it says it
    python: str
    libraries: dict[str, str]  # installed ones only

    def asdict(self) -> dict[str, Any]:
        return dataclasses.asdict(self)

    def rows(self) -> list[tuple[str, str]]:
        """The card as (name, value) pairs for people."""
        build = [(name.replace("_", " "), str(value)) for name, value in self.build.items() if name not in ("compiler", "commit")]
        return [
            ("interreflect", f"{self.version}, commit {self.commit}"),
            ("processor", f"{self.processor}, {self.cores} cores, {self.threads} threads, {self.memory_bytes / 2**30:.1f} GiB"),
            ("vectors", f"{self.vectors}, {self.vector_bits} bits" if self.vector_bits else UNKNOWN),
            ("system", self.system),
            ("compiler", self.compiler),
            *build,
            ("Python", self.python),
            ("libraries", ", ".join(f"{name} {version}" for name, version in self.libraries.items())),
        ]

    def __str__(self) -> str:
        return "\n".join(f"{name:14} {value}" for name, value in self.rows())

    def _repr_html_(self) -> str:
        cells = "".join(f"<tr><th>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in self.rows())
        return f"<table>{cells}</table>"


@cache
def about() -> About:
    """What this process runs on; asked once a process."""
    build = _build_info()
    vectors, vector_bits = _vectors()
    return About(
        version=_version("interreflect") or str(build.get("version", UNKNOWN)),
        commit=_commit() or str(build.get("commit") or UNKNOWN),
        processor=_processor(),
        cores=_cores(),
        threads=len(os.sched_getaffinity(0)),
        vectors=vectors,
        vector_bits=vector_bits,
        memory_bytes=os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        system=platform.platform(),
        compiler=str(build.get("compiler", UNKNOWN)),
        build=build,
        python=platform.python_version(),
        libraries={name: version for name in LIBRARIES if (version := _version(name))},
    )


def _build_info() -> dict[str, Any]:
    try:
        import interreflect._core as core
    except ModuleNotFoundError:
        return {}
    return dict(core.build_info)


def _version(distribution: str) -> str | None:
    try:
        return metadata.version(distribution)
    except metadata.PackageNotFoundError:
        return None


def _processor() -> str:
    cpuinfo = Path("/proc/cpuinfo")
    found = re.search(r"^model name\s*:\s*(.+)$", cpuinfo.read_text(), re.MULTILINE) if cpuinfo.exists() else None
    return found.group(1).strip() if found else platform.processor() or platform.machine() or UNKNOWN


def _cores() -> int:
    """Groups of threads that share a core, of those that this process may use."""
    shared = set()
    for thread in os.sched_getaffinity(0):
        siblings = Path(f"/sys/devices/system/cpu/cpu{thread}/topology/thread_siblings_list")
        shared.add(siblings.read_text() if siblings.exists() else str(thread))
    return len(shared)


def _vectors() -> tuple[str, int]:
    try:
        import interreflect._core as core
    except ModuleNotFoundError:
        return UNKNOWN, 0
    return core.vector_target(), 8 * core.vector_bytes()


def _commit() -> str:
    """The commit that is checked out, with "-dirty" if tracked files differ from it; empty where this file is in no checkout."""
    here = Path(__file__).resolve()
    tracked = _git(here.parent, "ls-files", "--error-unmatch", here.name)
    return _git(here.parent, "describe", "--always", "--dirty", "--abbrev=12", "--exclude=*") if tracked else ""


def _git(folder: Path, *arguments: str) -> str:
    """What git prints; empty where it fails or is not there."""
    try:
        done = subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True, timeout=5, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""
