"""Files that are either whole or absent, and that know when they were damaged."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import re
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import orjson

PART = ".part"  # suffix of files being written: <name>.<host>.<process>.part
DAMAGED = ".damaged"
HOST = socket.gethostname().replace(".", "-")  # folders may be shared between machines
HEAD = re.compile(rb'\{\s*"format":\s*(\d+),\s*"checksum":\s*"([0-9a-f]{64})",\s*"content":\s*')
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


def checked(content: Any, version: int) -> bytes:
    """A JSON text that holds content, keys in their own order, its format version and its checksum."""
    text = json.dumps(content, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
    return b'{"format":%d,"checksum":"%s","content":%s}' % (version, hashlib.sha256(text).hexdigest().encode(), text)


def write_checked(path: Path, content: Any, version: int) -> None:
    """Write JSON content with its format version and checksum."""
    with replacing(path) as file:
        file.write(checked(content, version))


def read_checked(path: str | Path, version: int) -> Any:
    """The content of a file of `write_checked`. DamagedFile where torn or altered, ValueError for another format version."""
    with open(path, "rb", buffering=0) as file:
        data = file.read()
    head = HEAD.match(data)
    if head is None:
        raise _other_format(path, data, version)
    if int(head[1]) != version:
        raise ValueError(f"{path}: format version must be {version}, got {int(head[1])}")
    text = memoryview(data)[head.end() : -1]
    if hashlib.sha256(text).hexdigest().encode() != head[2]:
        raise DamagedFile(f"{path}: content and checksum differ")
    return orjson.loads(text)


def _other_format(path: str | Path, data: bytes, version: int) -> ValueError:
    """What to say of a file that does not begin as ours do: the first format named its version at the end."""
    try:
        found = json.loads(data)["format"]
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        return DamagedFile(f"{path}: not a whole record ({error})")
    if found == version:
        return DamagedFile(f"{path}: not as it was written")
    return ValueError(f"{path}: format version must be {version}, got {found}")
