"""Directional lights that stand for a scene's environment, where a method makes maps of what lights see."""

from __future__ import annotations

from interreflect.methods.prepared import View
from interreflect.scenes.median_cut import directional_lights
from interreflect.scenes.values import DirectionalLight, EnvironmentLight


def suns_of(view: View, count: int) -> tuple[DirectionalLight, ...]:
    """So many of them, kept while the environment stays the same; none where there is none."""
    environment = next((light for light in view.scene.lights if isinstance(light, EnvironmentLight)), None)
    if environment is None:
        return ()
    up = tuple(view.scene.up)
    key = (environment.hash, up, count)
    if view.state.get("suns_of") != key:
        view.state["suns"] = directional_lights(environment, count, hemisphere=False, up=up)
        view.state["suns_of"] = key
    suns: tuple[DirectionalLight, ...] = view.state["suns"]
    return suns
