"""Pictures with numbers that are not finite: whatever is measured, they are beyond every tolerance."""

from __future__ import annotations

from interreflect.frame import Image


class NotFinite(ValueError):
    """A picture holds numbers that are not finite; it comes along."""

    def __init__(self, message: str, image: Image) -> None:
        super().__init__(message)
        self.image = image
