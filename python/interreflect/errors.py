"""Errors a user meets."""


class SceneError(ValueError):
    """A scene file that cannot be read; the message names the file and the key or line."""
