"""What all clients of a view share: the scene, and the methods made ready for it."""

from __future__ import annotations

from interreflect.methods.method import Method
from interreflect.methods.pieces import Pieces
from interreflect.methods.prepared import Prepared
from interreflect.scenes.scene import Scene

KEPT = 3  # methods that stay ready


class Shared:
    """For one thread alone, but for `is_ready`."""

    def __init__(self, scene: Scene, threads: int | None = None) -> None:
        self.scene = scene
        self.threads = threads
        self._pieces = Pieces()
        self._prepared: dict[Method, Prepared] = {}

    def is_ready(self, method: Method) -> bool:
        return method in self._prepared

    def prepared(self, method: Method) -> Prepared:
        """The method ready for the scene; the one that was not asked for longest is let go."""
        found = self._prepared.pop(method, None) or method.prepare(self.scene, self.threads, self._pieces)
        self._prepared[method] = found
        while len(self._prepared) > KEPT:
            self._prepared.pop(next(iter(self._prepared)))
        return found
