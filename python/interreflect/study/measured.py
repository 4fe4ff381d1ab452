"""How the tools that measure on their own do it: a study in a folder below the user's cache, so that they resume."""

from __future__ import annotations

import hashlib
import re
from pathlib import Path
from typing import Any

import interreflect.cache as cache
from interreflect.study.interface import Method, Scene
from interreflect.study.plan import cell_key
from interreflect.study.records import Record
from interreflect.study.run import run
from interreflect.study.store import Store
from interreflect.study.study import Study


def study_folder(tool: str, scene: Scene, *identity: Any) -> Path:
    """A folder of one tool's work on one scene, named after it and after what else tells it apart."""
    told_apart = hashlib.blake2b(repr((scene.hash, identity)).encode(), digest_size=6).hexdigest()
    name = re.sub(r"[^A-Za-z0-9]+", "-", scene.name).strip("-")
    return cache.folder("studies") / f"{tool}-{name or 'scene'}-{told_apart}"


def measured(study: Study, folder: str | Path) -> list[tuple[Record, ...]]:
    """The records of a study of one view, method by method, each in the order of the seeds. What failed is among them.

    Read cell by cell, not by the folder's list, which another tool's run on the same folder may have replaced meanwhile.
    """
    run(study, folder)
    store, cells = Store(folder), study.cells()
    records = [record for cell in cells if (record := store.read(cell_key(study, cell))) is not None]
    if len(records) != len(cells):
        raise ValueError(f"{folder}: {len(cells) - len(records)} of {len(cells)} cells cannot be read")
    cache.trim(keep=Path(folder))
    count = len(study.seeds)
    return [tuple(records[index : index + count]) for index in range(0, len(records), count)]


def same(method: Method) -> str:
    """Equal for methods with equal knobs."""
    return repr((method.name, sorted(method.knobs().items(), key=lambda knob: knob[0])))


def words(method: Method) -> str:
    """The method and the knobs in which it differs from its defaults; a technique that differs gives its name and its own knobs."""
    try:
        usual: dict[str, Any] = type(method)().knobs()
    except TypeError:  # a method without defaults
        usual = {}
    changed = {path: value for path, value in method.knobs().items() if path not in usual or usual[path] != value}
    return f"{method.name} {', '.join(f'{path}={value}' for path, value in changed.items())}".strip()
