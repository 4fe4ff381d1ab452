"""Table 1: 64 area lights with PCSS against 512 with simple lookups, step by step."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.panels import table_figure
from experiments.weinzierl_heigl.pipeline import CLEAN, FULL, SMALL, area_lights, compared, milliseconds, scene, study

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

PAPER_PRINTS = "in the table: milliseconds on a Radeon HD 6850"


def studies() -> Sequence[ir.Study]:
    """Timed at the paper's size; how near to the truth at a smaller one, where the truth's noise does not hide the difference."""
    ways = [area_lights(name) for name in NAMES]
    return [
        study("64 with PCSS and 512 simple", ways, size=FULL, repeats=5, images=False),
        compared("64 with PCSS and 512 simple, beside the truth", ways, size=SMALL, reference=CLEAN),
    ]


def elsewhere() -> dict[str, ir.Study]:
    """The same two where they were not set: the presets' knobs were chosen on the paper's view of its scene. Timed and compared at once."""
    across = ir.Camera(position=(-0.85, 1.6, 0.9), target=(0.7, 0.4, -0.7), fov_x=70.0)
    box = scene().replace(cameras={"across": across})
    spot = ir.SpotLight(position=(0, 8, 4), direction=(-0.2, -1, -0.6), intensity=(900, 800, 700), inner=32, outer=40)
    atrium = ir.scenes.atrium().replace(lights=[spot], name="atrium by a spot")
    places = {"the box from beside its lit wall": (box, "across"), "the atrium by a spot": (atrium, "court")}
    ways = [area_lights(name) for name in NAMES]
    return {
        name: compared(f"64 with PCSS and 512 simple, {name}", ways, at=at, camera=camera, repeats=5, size=SMALL, reference=CLEAN)
        for name, (at, camera) in places.items()
    }


def table(records: ir.Records) -> pd.DataFrame:
    """Milliseconds: a row per step; columns (configuration, ours or paper)."""
    columns = {}
    for i, name in enumerate(NAMES):
        steps = {step: milliseconds(records, i, stages) for step, stages in STEPS.items()}
        columns[name, "ours"] = {**steps, COMPLETE: sum(steps.values())}
        columns[name, "paper"] = dict(zip([*STEPS, COMPLETE], PAPER[name], strict=True))
    return pd.DataFrame(columns)


def errors(records: ir.Records) -> pd.DataFrame:
    """A row per configuration: `flip` of the picture and `relmse` of its indirect light, against one-bounce truth."""
    rows = {
        name: {"flip": record.metrics["flip"], "relmse": record.metrics["indirect_trimmed_relmse"]}
        for name, record in zip(NAMES, records, strict=True)
    }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(timed: ir.Records, near: ir.Records) -> Figure:
    off = errors(near)
    said = "\n".join(
        f"{name}: FLIP {row['flip']:.3f}, frame {record.milliseconds:.0f} ms"
        for (name, row), record in zip(off.iterrows(), timed, strict=True)
    )
    return table_figure(table(timed), f"milliseconds a frame (medians)\n{said}")
