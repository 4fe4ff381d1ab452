"""Values that hold arrays: equal, hashable and copied by content."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np


class Content:
    """Base of frozen dataclasses with array fields. `hash` names the content; `==` and `hash()` follow it."""

    def _digest(self) -> str:
        raise NotImplementedError

    @cached_property
    def hash(self) -> str:
        """Digest of the content, 32 hexadecimal digits; computed once."""
        return self._digest()

    def __eq__(self, other: object) -> bool:
        return self is other or (type(other) is type(self) and isinstance(other, Content) and other.hash == self.hash)

    def __hash__(self) -> int:
        return int(self.hash[:15], 16)

    def __setstate__(self, state: dict[str, Any]) -> None:
        for value in state.values():
            if isinstance(value, np.ndarray):
                value.flags.writeable = False  # pickling forgets the lock
        self.__dict__.update(state)
