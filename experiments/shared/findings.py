"""Answers that no paper gives: each a question's file, its chart and what its numbers say in words."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import interreflect as ir
from interreflect.machine import about

QUESTIONS = (
    "do_warps_pay",
    "when_is_tessellation_worth_it",
    "which_stage_costs_most_error",
    "what_does_each_scene_need",
    "do_rays_with_shared_samples_beat_cones",
    "when_does_runtime_projection_lose",
)


def write(folder: Path) -> Path:
    """Measures what is missing and writes `findings.md` with a picture beside it for each; intervals are of 95 %."""
    parts = ["# Findings", f"Measured on {about().processor}, {about().threads} threads. Brackets are intervals of 95 %."]
    for name in QUESTIONS:
        parts.append(section(name, folder))
        path = folder / "findings.md"
        path.write_text("\n\n".join(parts) + "\n")
        print(parts[-1], flush=True)
    return path


def section(name: str, folder: Path) -> str:
    question: Any = import_module(f"experiments.{name}")
    found = ir.run(question.study, folder / name) if hasattr(question, "study") else question.measure(folder / name)
    question.chart(found).savefig(folder / f"{name}.png", dpi=110)
    said = "\n".join(f"- {line}" for line in question.told(found).splitlines())
    return f"## {' '.join(question.__doc__.split())}\n\n![]({name}.png)\n\n{said}\n\n`./run figures {name}`"
