"""Finding and opening the files of a scene: the path rule of SCENE_FORMAT.md, size caps, and names for messages."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass, field
from pathlib import Path

from interreflect.errors import SceneError
from interreflect.scenes.checks import shorten
from interreflect.scenes.texture import MAX_PIXELS

EXTENSIONS = (".obj", ".ply", ".gltf", ".glb")
MAX_MANIFEST_BYTES = 2**22
MAX_GEOMETRY_BYTES = 2**30
MAX_SCENE_PIXELS = 2**30

_SCHEME = re.compile(r"[A-Za-z][A-Za-z0-9+.-]*:")


def shown(path: str | os.PathLike[str]) -> str:
    """A file as messages name it: its folder and name."""
    absolute = Path(os.path.abspath(path))
    return f"{absolute.parent.name}/{absolute.name}" if absolute.parent.name else absolute.name


def _can_be_a_path(name: str) -> bool:
    try:
        return b"\0" not in os.fsencode(name)
    except UnicodeEncodeError:  # half a character, as JSON can spell it
        return False


def read_bytes(path: str, limit: int) -> bytes:
    """The whole file, refused before it is read where it is larger than `limit` bytes."""
    try:
        with open(path, "rb") as file:
            size = os.fstat(file.fileno()).st_size
            if size > limit:
                raise SceneError(f"{shown(path)}: {size} bytes are more than the {limit} that are read")
            return file.read(limit + 1)
    except OSError as error:
        raise SceneError(f"{shown(path)}: cannot be read: {error.strerror}") from None


@dataclass
class Folder:
    """The folder of a manifest: opens what lies in or beside it, remembers every name asked for and what was odd."""

    base: str
    used: dict[str, str | None] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    pixels: int = 0

    @staticmethod
    def of(path: str) -> Folder:
        return Folder(os.path.realpath(os.path.dirname(os.path.abspath(path))))

    def locate(self, name: object, where: str, beside: str | None = None) -> str | None:
        """Path of `name`, relative to the file `beside` or to the manifest; None where there is no such file.

        SceneError where the name is absolute, has a scheme, or leads (also by links) above the folder that holds the
        manifest's folder. `where` opens the message.
        """
        if not isinstance(name, str) or not name:
            raise SceneError(f"{where} must be a file name, got {shorten(name)}")
        if not _can_be_a_path(name) or os.path.isabs(name) or name.startswith("\\") or _SCHEME.match(name):
            raise SceneError(f"{where} must be a relative path without a scheme, got {shorten(name)}")
        start = os.path.dirname(beside) if beside else self.base
        key = os.path.join(os.path.relpath(start, self.base), name)
        if key in self.used:
            return self.used[key]
        path = os.path.realpath(os.path.join(start, name))
        root = os.path.dirname(self.base)
        if os.path.commonpath([root, path]) != root:
            raise SceneError(f"{where} must not lead above the folder that holds the scene's folder, got {shorten(name)}")
        self.used[key] = path if os.path.isfile(path) else None
        return self.used[key]

    def require(self, name: object, where: str, beside: str | None = None) -> str:
        """As `locate`; SceneError where there is no such file."""
        path = self.locate(name, where, beside)
        if path is None:
            raise SceneError(f"{where} {shorten(name)} does not exist")
        return path

    def count_pixels(self, path: str, count: int) -> None:
        """SceneError where one image, or all of the scene's together, have more pixels than are read."""
        self.pixels += count
        if count > MAX_PIXELS:
            raise SceneError(f"{shown(path)}: {count} pixels are more than the {MAX_PIXELS} that are read")
        if self.pixels > MAX_SCENE_PIXELS:
            raise SceneError(f"{shown(path)}: the scene's images have more than the {MAX_SCENE_PIXELS} pixels that are read")
