"""Writes a study's cells while it goes on, but never while a frame is timed: syncing a file takes milliseconds of waiting."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor, wait

from interreflect.study.interface import Frame
from interreflect.study.records import Record
from interreflect.study.reference import Truth
from interreflect.study.store import Store


class Writer:
    """One thread that writes what it is given, in order: a cell's pictures, then its record. Leaving the block waits for all of it."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._thread = ThreadPoolExecutor(1)
        self._pending: list[Future[None]] = []

    def __enter__(self) -> Writer:
        return self

    def __exit__(self, failure: type[BaseException] | None, *_: object) -> None:
        self._thread.shutdown()
        if failure is None:
            self._raise_failures()

    def pictures(self, key: str, frame: Frame, truth: Truth) -> None:
        self._pending.append(self._thread.submit(self._store.write_pictures, key, frame, truth))

    def record(self, record: Record) -> None:
        """The last thing of a cell. OSError where an earlier one could not be written."""
        self._raise_failures()
        before = list(self._pending)

        def write() -> None:
            for earlier in before:
                earlier.result()  # a record whose pictures could not be written is not written either
            self._store.write(record)

        self._pending.append(self._thread.submit(write))

    def settle(self) -> None:
        """Return once nothing is being written any more."""
        wait(self._pending)

    def _raise_failures(self) -> None:
        done = [future for future in self._pending if future.done()]
        self._pending = [future for future in self._pending if future not in done]
        for future in done:
            future.result()
