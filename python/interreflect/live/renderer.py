"""The one thread that renders: clients take turns, the newest wish of each counts, and who rests gets a better truth."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable
from dataclasses import dataclass

from interreflect.live.session import Picture, Session

EXPECTED = (ValueError, TypeError, MemoryError, ImportError, OSError)  # what settings may lead to; all else is a fault of ours

MOST_SECONDS = 2.0  # that an end waits for the picture at work


@dataclass(frozen=True, eq=False)
class Client:
    """show: called with every picture. complain: with the words of what went wrong. begin: before a picture is made."""

    session: Session
    show: Callable[[Picture], None]
    complain: Callable[[str], None]
    begin: Callable[[], None]


class Renderer:
    """`add`, `remove` and `wake` may be called by any thread."""

    def __init__(self) -> None:
        self._clients: dict[int, Client] = {}
        self._changed = threading.Condition()
        self._stopped = False
        self._last = -1  # number of the client that had the last turn
        self._thread = threading.Thread(target=self._run, name="interreflect view", daemon=True)
        self._thread.start()

    def add(self, number: int, client: Client) -> None:
        with self._changed:
            self._clients[number] = client
            self._changed.notify()

    def remove(self, number: int) -> None:
        with self._changed:
            self._clients.pop(number, None)

    def wake(self) -> None:
        """A session wishes for something else."""
        with self._changed:
            self._changed.notify()

    def stop(self) -> None:
        """Nothing is shown any more. A preparation at work goes on by itself: it may take minutes, and nobody waits for it here."""
        with self._changed:
            self._stopped = True
            self._clients.clear()
            self._changed.notify()
        self._thread.join(MOST_SECONDS)

    def _run(self) -> None:
        while (turn := self._next()) is not None:
            client, makes_picture = turn
            try:
                if makes_picture:
                    client.begin()
                picture = client.session.step() if makes_picture else client.session.refine()
                if client in self._clients.values():  # it may have left meanwhile
                    client.show(picture)
            except EXPECTED as error:
                client.complain(f"{type(error).__name__}: {error}")
            except Exception as error:
                traceback.print_exc()
                client.complain(f"{type(error).__name__}: {error}")

    def _next(self) -> tuple[Client, bool] | None:
        """Whose turn it is, and whether for a picture or for a truth; waits until there is one. None: stopped."""
        with self._changed:
            while not self._stopped:
                numbers = sorted(self._clients, key=lambda number: (number <= self._last, number))
                for makes_picture in (True, False):
                    for number in numbers:
                        client = self._clients[number]
                        if client.session.is_stale if makes_picture else client.session.may_refine:
                            self._last = number
                            return client, makes_picture
                self._changed.wait()
        return None
