"""Files that are either whole or absent, and that know when they were damaged."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

PART = ".part"  # suffix of files being written: <name>.<host>.<process>.part
DAMAGED = ".damaged"
HOST = socket.gethostname().replace(".", "-")  # folders may be shared between machines
NO_ROOM = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG}


class DamagedFile(ValueError):
    """A file whose content is not what was written."""


class DiskFull(OSError):
    """There is no room for a file; what was written before is whole."""


@contextmanager
def replacing(path: Path, sync: bool = True) -> Iterator[IO[bytes]]:
    """A binary file that appears under `path` only once it is whole: temporary name, fsync, rename.

    `sync=False` leaves the fsync out, for files whose damage shows when they are read. DiskFull where there is no room.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.{HOST}.{os.getpid()}{PART}")
    try:
        with open(part, "wb") as file:
            yield file
            file.flush()
            if sync:
                os.fsync(file.fileno())
        os.replace(part, path)
    except OSError as error:
        if error.errno in NO_ROOM:
            raise DiskFull(error.errno, f"no room for {path}; what was written before is whole ({os.strerror(error.errno)})") from error
        raise
    finally:
        part.unlink(missing_ok=True)


def remove_parts(folder: Path) -> None:
    """Remove what processes of this machine that no longer run left half written."""
    for part in folder.rglob(f"*{PART}"):
        rest, _, process = part.name.removesuffix(PART).rpartition(".")
        host = rest.rpartition(".")[2]
        if host == HOST and process.isdigit() and int(process) != os.getpid() and not Path(f"/proc/{process}").exists():
            part.unlink(missing_ok=True)


def set_aside(path: Path) -> Path:
    """Rename a damaged file so that it is in nobody's way but can be looked at."""
    aside = path.with_name(path.name + DAMAGED)
    os.replace(path, aside)
    return aside


def canonical(content: Any) -> str:
    """JSON with one spelling for equal content."""
    return json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def checksum(content: Any) -> str:
    return hashlib.sha256(canonical(content).encode()).hexdigest()


def write_checked(path: Path, content: Any, version: int) -> None:
    """Write JSON content with its format version and checksum."""
    with replacing(path) as file:
        file.write(canonical({"format": version, "checksum": checksum(content), "content": content}).encode())


def read_checked(path: Path, version: int) -> Any:
    """The content of a file of `write_checked`. DamagedFile where torn or altered, ValueError for another format version."""
    try:
        envelope = json.loads(path.read_bytes())
        found, content = envelope["format"], envelope["content"]
        whole = envelope["checksum"] == checksum(content)
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise DamagedFile(f"{path}: not a whole record ({error})") from error
    if not whole:
        raise DamagedFile(f"{path}: content and checksum differ")
    if found != version:
        raise ValueError(f"{path}: format version must be {version}, got {found}")
    return content
