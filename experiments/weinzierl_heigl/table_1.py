"""Table 1: 64 area lights with PCSS against 512 with simple lookups, step by step."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.panels import table_figure
from experiments.weinzierl_heigl.pipeline import FULL, area_lights, compared, milliseconds

NAMES = ("64 with PCSS", "512 simple")
# The paper's steps and the stages that do their work here; its complete time is their sum.
STEPS = {
    "clustering": ("sample_lights", "cluster_lights"),
    "indirect illumination": ("shade_lights", "shade"),
    "imperfect shadow maps": ("shadow_lights",),
}
COMPLETE = "complete"
# Milliseconds on a Radeon HD 6850.
PAPER = {"64 with PCSS": (5.0, 11.0, 10.0, 26.0), "512 simple": (5.0, 30.0, 17.0, 52.0)}


def studies() -> Sequence[ir.Study]:
    return [compared("64 with PCSS and 512 simple", [area_lights(name) for name in NAMES], size=FULL, repeats=5)]


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per step; columns (configuration, ours or paper)."""
    columns = {}
    for i, name in enumerate(NAMES):
        steps = {step: milliseconds(records, i, stages) for step, stages in STEPS.items()}
        columns[name, "ours"] = {**steps, COMPLETE: sum(steps.values())}
        columns[name, "paper"] = dict(zip([*STEPS, COMPLETE], PAPER[name], strict=True))
    return pd.DataFrame(columns)


def errors(records: ir.Records) -> pd.DataFrame:
    """A row per configuration: `flip` of the picture and `relmse` of its indirect light, against one-bounce truth;
    `frame`, milliseconds."""
    rows = {
        name: {"flip": record.metrics["flip"], "relmse": record.metrics["indirect_trimmed_relmse"], "frame": record.milliseconds}
        for name, record in zip(NAMES, records, strict=True)
    }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    off = errors(records)
    said = "; ".join(f"{name}: FLIP {row['flip']:.3f}, frame {row['frame']:.0f} ms" for name, row in off.iterrows())
    return table_figure(table(records), f"milliseconds a frame (medians)\n{said}")
