"""Advice in words: what to use for a view, what may be dropped, and on which measurements this rests."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from interreflect.study.attribution import EXACT, FIXED, MEASURED, NO_COUNTERPART, NO_EFFECT, Attribution, attribute
from interreflect.study.interface import Scene
from interreflect.study.ladder import Ladder, Mechanism, Rung, ladder
from interreflect.study.marginal import Marginals, marginal
from interreflect.study.measured import words
from interreflect.study.reference import Reference

LARGEST = 3  # stages and knobs named of each kind
SMALL_SHARE = 0.03  # of a frame's error: a stage whose counterpart gains less need not be better


@dataclasses.dataclass(frozen=True, eq=False)
class Advice:
    """`text` in words; the measurements it rests on: the ladder, and of the recommended method attribution and marginals."""

    text: str
    ladder: Ladder
    attribution: Attribution
    marginals: Marginals

    def __str__(self) -> str:
        return self.text

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return "".join(f"<p>{line}</p>" for line in self.text.split("\n"))


def advise(
    scene: Scene,
    camera: str | None = None,
    size: tuple[int, int] = (160, 90),
    milliseconds: float | None = None,
    reference: Reference | None = None,
    folder: str | Path | None = None,
    rungs: Sequence[Mechanism] | None = None,
) -> Advice:
    """What to use for a view within `milliseconds` a frame (None: whatever it takes), what may be dropped, and why.

    Climbs the ladder, then attributes the error of the recommended method to its stages and tries its knobs' next steps. Everything
    measured is a record (folder: of all of them; None: the user's cache). rungs: the mechanisms of the ladder (None: its own).
    """
    places: dict[str, Any] = {name: None if folder is None else Path(folder) / name for name in ("ladder", "attribution", "marginal")}
    climbed = ladder(scene, camera, size, rungs=rungs, reference=reference, folder=places["ladder"])
    chosen = _chosen(climbed, milliseconds)
    method: Any = chosen.method
    stages = attribute(method, scene, climbed.camera, size, reference=reference, folder=places["attribution"])
    steps = marginal(method, scene, climbed.camera, size, reference=reference, folder=places["marginal"])
    lines = [*_use(climbed, chosen, milliseconds), *_drop(climbed, stages, steps), *_improve(stages, steps), _rests(climbed, stages, steps)]
    return Advice("\n".join(lines), climbed, stages, steps)


def _chosen(climbed: Ladder, milliseconds: float | None) -> Rung:
    """The most accurate rung within the budget; the fastest where none is."""
    within = [rung for rung in climbed.needed if milliseconds is None or rung.milliseconds <= milliseconds]
    return min(within, key=lambda rung: rung.error) if within else min(climbed.rungs, key=lambda rung: rung.milliseconds)


def _use(climbed: Ladder, chosen: Rung, milliseconds: float | None) -> list[str]:
    over = milliseconds is not None and chosen.milliseconds > milliseconds
    budget = "" if milliseconds is None else f" (budget {milliseconds:g} ms{', which nothing meets' if over else ''})"
    lines = [
        f"For {climbed.scene.name}, {climbed.camera}, at {climbed.size[0]} x {climbed.size[1]}{budget} use {words(chosen.method)}: "
        f"relMSE {chosen.error:.3g} against all bounces in {chosen.milliseconds:.1f} ms."
    ]
    needed = [f"{rung.mechanism} ({rung.error:.3g} in {rung.milliseconds:.1f} ms)" for rung in climbed.needed]
    lines.append(f"Mechanisms that lower the error beyond noise, with what is left: {', '.join(needed)}.")
    return lines


def _drop(climbed: Ladder, stages: Attribution, steps: Marginals) -> list[str]:
    idle = [f"{rung.mechanism} (gain {rung.gain:.1e})" for rung in climbed.rungs if not rung.needed]
    silent = [stage.stage for stage in stages.stages if stage.note == NO_EFFECT]
    lines = []
    if idle:
        lines.append(f"May be dropped, as they lower the error by no more than noise: {', '.join(idle)}.")
    if silent:
        lines.append(f"Stages of {stages.method.name} whose exact counterpart changes nothing here: {', '.join(silent)}.")
    table = steps.table
    if len(table):
        saving = table[(table["note"] == "within noise") & (table["milliseconds"] < -0.05 * steps.milliseconds)].sort_values("milliseconds")
        best = saving.groupby("knob", sort=False).head(1).head(LARGEST)
        saved = [f"{row['knob']} {row['from']} to {row['to']} ({-row['milliseconds']:.1f} ms)" for _, row in best.iterrows()]
        if saved:
            lines.append(f"Saves time at no error that shows: {', '.join(saved)}.")
    return lines


def _improve(stages: Attribution, steps: Marginals) -> list[str]:
    ranked = [f"{s.stage} {s.error:.0%} (95 %: {s.low:.0%} to {s.high:.0%}; {s.time:.0%} of the time)" for s in stages.ranking[:LARGEST]]
    whole = f"Of {stages.method.name}'s error against its own transport ({stages.error:.3g}, {stages.noise:.3g} of it noise)"
    unmeasured = [stage.stage for stage in stages.stages if stage.status in (NO_COUNTERPART, FIXED)]
    lines = [f"{whole} most comes from: {', '.join(ranked)}."] if ranked else [f"{whole} no stage's share exceeds noise."]
    lines[0] += f" {stages.rest:.0%} stay with every counterpart in place (without one: {', '.join(unmeasured)})."
    small = [
        s.stage for s in stages.stages if s.status == EXACT or (s.status in MEASURED and s.note != NO_EFFECT and s.error < SMALL_SHARE)
    ]
    if small:
        lines.append(f"Exact, or as good as: {', '.join(small)}.")
    table = steps.table
    if len(table):
        gains = table[(table["note"] == "") & (table["error"] < 0)].sort_values("error").groupby("knob", sort=False).head(1).head(LARGEST)
        bought = [
            f"{row['knob']} {row['from']} to {row['to']}: {row['error']:+.2g}, {row['milliseconds']:+.1f} ms, {row['megabytes']:+.1f} MiB"
            for _, row in gains.iterrows()
        ]
        lines.append(
            f"The next steps that lower it: {'; '.join(bought)}." if bought else "No single step of a knob lowers it beyond noise."
        )
    return lines


def _rests(climbed: Ladder, stages: Attribution, steps: Marginals) -> str:
    cells = sum(len(rung.settings) * len(rung.records) for rung in climbed.rungs)
    machine = climbed.rungs[0].records[0].machine
    where = f"{machine.get('processor', 'an unknown processor')} with {climbed.rungs[0].records[0].threads} threads"
    return (
        f"This rests on {cells} cells of the ladder, {len(stages.records)} of the attribution and {len(steps.table) + 1} settings "
        f"around it, measured on {where}; the truth's own noise is relMSE {climbed.truth_noise:.1e} (all bounces) and "
        f"{stages.truth_noise:.1e} (the method's). Records: {climbed.folder}, {stages.records.folder}, {steps.folder}."
    )
