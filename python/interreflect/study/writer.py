"""Writes a study's cells while it goes on, but never while a frame is timed: syncing a file takes milliseconds of waiting."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any


class Writer:
    """One thread that does what it is given, in order, up to the first failure. Leaving the block waits for all of it."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1)
        self._pending: deque[Future[None]] = deque()
        self._failed = False

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, failure: type[BaseException] | None, *_: object) -> None:
        self._thread.shutdown()
        if failure is None:
            self._raise_failures()

    def do(self, work: Callable[..., object], *given: Any) -> None:
        """Call `work(*given)` when its turn comes. OSError where something before could not be written."""
        self._raise_failures()
        self._pending.append(self._thread.submit(self._next, work, given))

    def settle(self) -> None:
        """Return once nothing is being written any more."""
        wait(self._pending)

    def _next(self, work: Callable[..., object], given: tuple[Any, ...]) -> None:
        if self._failed:  # a record may rest on the pictures before it
            return
        try:
            work(*given)
        except BaseException:
            self._failed = True
            raise

    def _raise_failures(self) -> None:
        while self._pending and self._pending[0].done():
            self._pending.popleft().result()
