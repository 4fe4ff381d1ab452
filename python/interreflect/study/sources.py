"""A digest of the code that makes a picture, so that repaired code makes new truths and new records."""

from __future__ import annotations

import hashlib
import inspect
from functools import cache
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent.parent
# Python files that draw, list or read, or whose effect is in the scene's hash already.
WITHOUT_EFFECT = {
    "__init__.py", "cache.py", "catalogue.py", "charts", "cli.py", "demo.py", "errors.py", "images.py", "machine.py", "metrics.py",
    "scenes", "stability", "study",
}  # fmt: skip


@cache
def source_digest(method: type, *others: Path) -> str:
    """blake2b of the sources that the core was built from, the package's rendering sources, `method`'s own files and `others`."""
    from interreflect import _core

    hasher = hashlib.blake2b(_core.build_info["sources"].encode(), digest_size=16)
    for path in sorted({*_package_files(), *_defining_files(method), *others}):
        hasher.update(path.name.encode() + b"\0" + hashlib.blake2b(path.read_bytes()).digest())
    return hasher.hexdigest()


def _package_files() -> set[Path]:
    rendering = {path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).parts[0] not in WITHOUT_EFFECT}
    return rendering | {PACKAGE / "scenes" / "compile.py"}  # how a scene goes to the core is not in its hash


def _defining_files(method: type) -> set[Path]:
    modules = [inspect.getmodule(base) for base in method.__mro__ if base is not object]
    files = [getattr(module, "__file__", None) for module in modules]
    return {Path(file).resolve() for file in files if file and Path(file).exists()}
