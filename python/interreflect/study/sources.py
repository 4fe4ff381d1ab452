"""A digest of the code that makes a picture, so that repaired code makes new truths and new records."""

from __future__ import annotations

import hashlib
import inspect
from functools import cache
from pathlib import Path
from types import CodeType

PACKAGE = Path(__file__).resolve().parent.parent
# Python files that draw, list or read, or whose effect is in the scene's hash already.
WITHOUT_EFFECT = {
    "__init__.py", "_worker.py", "cache.py", "catalogue.py", "charts", "cli.py", "demo.py", "display.py", "errors.py", "images.py",
    "machine.py", "metrics.py", "progress.py", "scenes", "stability", "study",
}  # fmt: skip


@cache
def source_digest(method: type, *others: Path) -> str:
    """blake2b of the sources that the core was built from, the package's rendering sources, `method`'s own files and `others`."""
    from interreflect import _core

    hasher = hashlib.blake2b(_core.build_info["sources"].encode(), digest_size=16)
    for path in sorted({*_package_files(), *_defining_files(method), *others}):
        hasher.update(path.name.encode() + b"\0" + hashlib.blake2b(path.read_bytes()).digest())
    for code in _code_without_file(method):
        hasher.update(code)
    return hasher.hexdigest()


def package_digest() -> str:
    """`source_digest` of the package alone: equal where two processes run the same code."""
    return source_digest(object)


def _package_files() -> set[Path]:
    rendering = {path for path in PACKAGE.rglob("*.py") if path.relative_to(PACKAGE).parts[0] not in WITHOUT_EFFECT}
    return rendering | {PACKAGE / "scenes" / "compile.py"}  # how a scene goes to the core is not in its hash


def _defining_files(method: type) -> set[Path]:
    return {file for base in method.__mro__ if base is not object and (file := _file_of(base))}


def _file_of(base: type) -> Path | None:
    """The file that defines a class: its module's, or that of its functions where the module is gone (runpy) or has none (a notebook)."""
    files = [getattr(inspect.getmodule(base), "__file__", None), *(code.co_filename for code in _codes(base))]
    return next((Path(file).resolve() for file in files if file and Path(file).exists()), None)


def _code_without_file(method: type) -> list[bytes]:
    """What stands for the source of classes that no file defines: the code of their functions and their other attributes."""
    found = []
    for base in method.__mro__:
        if base is not object and _file_of(base) is None:
            plain = sorted((name, repr(value)) for name, value in vars(base).items() if isinstance(value, bool | int | float | str | None))
            found.append(repr((base.__qualname__, plain, [_portrait(code) for code in _codes(base)])).encode())
    return found


def _codes(base: type) -> list[CodeType]:
    functions = [inspect.unwrap(getattr(value, "fget", None) or getattr(value, "__func__", value)) for value in vars(base).values()]
    return [function.__code__ for function in functions if inspect.isfunction(function)]


def _portrait(code: CodeType) -> tuple[object, ...]:
    """What a function does, without where it stands."""
    return code.co_name, code.co_code, code.co_names, [_constant(value) for value in code.co_consts]


def _constant(value: object) -> object:
    """A constant as text of one spelling: sets have no order of their own."""
    if isinstance(value, CodeType):
        return _portrait(value)
    return sorted(map(repr, value)) if isinstance(value, frozenset) else repr(value)
