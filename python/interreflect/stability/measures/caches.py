"""What caches leave out."""

from __future__ import annotations

from interreflect.stability.failure import Reading, Trial


def uncovered(trial: Trial) -> Reading:
    """Share of the pixels with a surface whose caches' weights sum up to 0; the truth is 0.

    0 for methods that interpolate nothing: each of their pixels has light of its own.
    """
    frame = trial.render()
    counts = {} if (stage := frame.profile.stages.get("interpolate")) is None else stage.counts
    without, with_one = counts.get("uncovered_pixels", 0), counts.get("covered_pixels", 0)
    return Reading(without / (without + with_one) if without else 0.0, frame.image)
