"""What methods precompute for one scene, piece by piece: a method that needs the same piece as the last one takes it as it is."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Piece:
    key: tuple[Any, ...]  # the values of all that it was made from but the scene
    value: Any
    milliseconds: float


@dataclass(eq=False)
class Pieces:
    """`pieces = ir.Pieces()`, then `method.prepare(scene, pieces=pieces)` for one method after the other.

    At most one piece of every name is kept, the last; before another one is made, it is let go. Times stay those of each method alone: a
    piece that was taken counts what it took to make.
    """

    keeps: bool = True
    _of: tuple[Any, ...] = ()  # scene and threads
    _kept: dict[str, Piece] = field(default_factory=dict, repr=False)
    saved_milliseconds: float = 0.0  # what the pieces that the last preparation took as they were had taken to make

    def begin(self, of: tuple[Any, ...]) -> None:
        """A preparation: pieces of another scene or number of threads are let go."""
        self.saved_milliseconds = 0.0
        if of != self._of:
            self._kept.clear()
            self._of = of

    def take(self, name: str, key: tuple[Any, ...], make: Callable[[], Any]) -> Any:
        """The piece, made where the last of its name has another key."""
        kept = self._kept.get(name)
        if kept is not None and kept.key == key:
            self.saved_milliseconds += kept.milliseconds
            return kept.value
        del kept
        self._kept.pop(name, None)
        start = time.perf_counter()
        made = Piece(key, make(), 1e3 * (time.perf_counter() - start))
        if self.keeps:
            self._kept[name] = made
        return made.value
