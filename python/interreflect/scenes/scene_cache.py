"""Loaded scenes in the user's cache folder, found again by the content of every file they were made of.

    scenes/<digest of the path>.files     the names that the scene's files refer to
    scenes/<digest of all content>.scene  the scene

The second digest covers each of those files' bytes (or its absence) and the loader's sources.
"""

from __future__ import annotations

import hashlib
import os
from functools import cache as once
from pathlib import Path

import interreflect.cache as cache
from interreflect.errors import SceneError
from interreflect.scenes.digest import digest
from interreflect.scenes.files import Folder
from interreflect.scenes.scene import Scene
from interreflect.scenes.stored import array_bytes, read_stored, write_scene
from interreflect.study.files import DamagedFile, checked, read_checked, set_aside

KIND = "scenes"
FORMAT = 1
LEAST_BYTES = 2**20  # smaller scenes load as quickly from their own files


def cached(path: str) -> Scene | None:
    """The scene that the file at `path` makes now, where it was kept."""
    try:
        names = read_checked(_list_path(path), FORMAT)
        key = _content_key(path, names)
    except (OSError, DamagedFile, ValueError):
        return None
    kept = cache.folder(KIND) / f"{key}.scene"
    try:
        scene = read_stored(kept)
    except FileNotFoundError:
        return None
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        set_aside(kept)
        return None
    cache.touch(kept)
    cache.touch(_list_path(path))
    return scene


def keep(path: str, scene: Scene, folder: Folder) -> None:
    """Keeps a scene of some size for the next time."""
    if array_bytes(scene) < LEAST_BYTES:
        return
    names = sorted(folder.used)
    try:
        key = _content_key(path, names)
    except (OSError, SceneError):  # a file went away while it was read
        return
    envelope = checked(names, FORMAT)
    if cache.write(cache.folder(KIND) / f"{key}.scene", lambda file: write_scene(scene, file)):
        cache.write(_list_path(path), lambda file: file.write(envelope))


def _list_path(path: str) -> Path:
    return cache.folder(KIND) / f"{digest('scene', os.path.realpath(path))}.files"


def _content_key(path: str, names: list[str]) -> str:
    """Digest of the content of the scene's file and of every file it names; SceneError where a name breaks the path rule."""
    folder = Folder.of(path)
    parts: list[tuple[str, str | None]] = [(os.path.basename(path), _file_digest(path))]
    for name in names:
        found = folder.locate(name, name)
        parts.append((name, None if found is None else _file_digest(found)))
    return digest("scene", FORMAT, _sources(), tuple(parts))


def _file_digest(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, lambda: hashlib.blake2b(digest_size=16)).hexdigest()


@once
def _sources() -> str:
    """Digest of the loader: this folder without the built-in scenes."""
    files = sorted(Path(__file__).parent.glob("*.py"))
    return digest("sources", tuple((file.name, file.read_text(encoding="utf-8")) for file in files))
