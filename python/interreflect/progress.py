"""The bar of long work: how far it is, and how long it still takes. In terminals and notebooks; nowhere else, unless somebody listens."""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable, Iterator
from typing import Any

_listeners: list[Callable[[str], object]] = []  # the last one is told


def bar(steps: Any = None, **options: Any) -> Any:
    """A tqdm bar with tqdm's arguments, shown in a terminal or a notebook; in a notebook as text, which needs no widgets."""
    from tqdm import tqdm

    if _listeners:
        silent = type("tqdm", (tqdm,), {"monitor_interval": 0})  # without tqdm's thread, which would stay beside the clock
        return silent(steps, **options | _in_words(_listeners[-1]))
    return tqdm(steps, disable=not (sys.stderr.isatty() or in_notebook()), **options)


@contextlib.contextmanager
def told_to(listener: Callable[[str], object]) -> Iterator[None]:
    """Bars that are made meanwhile are not shown but told, in words, at most ten times a second."""
    _listeners.append(listener)
    try:
        yield
    finally:
        _listeners.remove(listener)


def in_notebook() -> bool:
    """Does this run in the kernel of a notebook?"""
    if "IPython" not in sys.modules:
        return False
    from IPython import get_ipython

    shell = get_ipython()
    return shell is not None and hasattr(shell, "kernel")


def _in_words(listener: Callable[[str], object]) -> dict[str, Any]:
    words = "{n_fmt} of {total_fmt} {unit}{postfix}, {remaining} left"
    return {"file": _Listening(listener), "bar_format": words, "delay": 0, "leave": True, "ascii": True, "disable": False}


class _Listening(io.StringIO):
    """A terminal that hands on every line."""

    def __init__(self, listener: Callable[[str], object]) -> None:
        super().__init__()
        self._listener = listener

    def write(self, text: str) -> int:
        if text.strip():
            self._listener(text.strip())
        return len(text)
