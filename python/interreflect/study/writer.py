"""Writes a study's cells while it goes on, but never while a frame is timed: syncing a file takes milliseconds of waiting."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait

from interreflect.study.calibration import Calibration
from interreflect.study.messages import Pair
from interreflect.study.records import Record
from interreflect.study.store import Store


class Writer:
    """One thread that writes the cells it is given, in order. Leaving the block waits for all of them."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._thread = ThreadPoolExecutor(1)
        self._pending: deque[Future[None]] = deque()

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, failure: type[BaseException] | None, *_: object) -> None:
        self._thread.shutdown()
        if failure is None:
            self._raise_failures()

    def write(self, record: Record, pictures: Pair | None, truth: Pair | None, then: Callable[[], None]) -> None:
        """A cell, and then `then()`. OSError where an earlier one could not be written."""
        self._raise_failures()

        def write() -> None:
            self._store.write(record, pictures, truth)
            then()

        self._pending.append(self._thread.submit(write))

    def calibration(self, calibration: Calibration) -> None:
        self._pending.append(self._thread.submit(self._store.write_calibration, calibration))

    def settle(self) -> None:
        """Return once nothing is being written any more."""
        wait(self._pending)

    def _raise_failures(self) -> None:
        while self._pending and self._pending[0].done():
            self._pending.popleft().result()
