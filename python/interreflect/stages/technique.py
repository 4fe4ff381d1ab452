"""The techniques of stages, and their exact counterparts."""

from __future__ import annotations

from typing import Any

from interreflect import _core


def techniques(stage: str) -> tuple[type, ...]:
    """Every technique of a stage. ValueError names the stages there are."""
    if stage not in _core.stages:
        raise ValueError(f"there is no stage {stage!r}; the stages are {', '.join(_core.stages)}")
    return tuple(_core.stages[stage]["techniques"])


def exact(technique: Any) -> Any:
    """The exact counterpart of a technique: its stage's slow, unapproximated one. ValueError for a stage without.

    Around another technique: of light without history, that of what it holds; of all bounces, all bounces of exact light.
    """
    if isinstance(technique, _core.BlendHistory):
        return exact(technique.light_voxels)
    if isinstance(technique, _core.Bounces):
        return technique.replace(light_voxels=exact(technique.light_voxels))
    for stage in type(technique).stages:
        counterpart = _core.stages[stage]["exact"]
        if counterpart is not None:
            return technique if isinstance(technique, counterpart) else counterpart()
    raise ValueError(f"{type(technique).__name__} belongs to {', '.join(type(technique).stages)}, which has no exact counterpart")
