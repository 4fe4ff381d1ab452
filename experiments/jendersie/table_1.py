"""Table 1: Real-time methods beside each other: error of diffuse and of glossy light, time, and what lights cost."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import SMALL, compared, composition, study
from experiments.shared.panels import table_figure
from experiments.shared.scenes import sunny_phong_sponza, sunny_sponza

REFERENCE = ir.Reference(noise=2e-3, max_spp=512)
LAMPS = 8

PAPER_PRINTS = "no numbers: stars for glossy light and speed, and words for lights and objects"


def ways() -> dict[str, Any]:
    """The paper's rows, as far as there are methods: cones for cones, one cascade for its several; for its other caches, ours."""
    return {
        "composition": composition(),
        "voxel cones": ir.methods.VoxelConeTracing(glossy=ir.GlossyCone()).replace({"grid.resolution": 128}),
        "light propagation": ir.methods.LightPropagationVolumes(),
        "clustered caches": ir.methods.ClusteredRadianceCaching(),
        "virtual area lights": ir.methods.VirtualAreaLights(),
    }


def lamps(count: int) -> ir.Scene:
    """The box with so many of its lamp, along its ceiling, which share its light."""
    box = ir.scenes.cornell_box(light="point")
    (lamp,) = box.lights
    x, y, z = lamp.position
    places = [(x + 0.4 * (2 * (k + 0.5) / count - 1), y, z) for k in range(count)]
    shares = tuple(one / count for one in lamp.intensity)
    return box.replace(lights=[ir.PointLight(position=place, intensity=shares) for place in places], name=f"box with {count} lamps")


def studies() -> Sequence[ir.Study]:
    methods = list(ways().values())
    few = [way.replace({"place_surfels.surfels": 32768}) if isinstance(way, ir.methods.IlluminanceComposition) else way for way in methods]
    return [
        compared("methods, diffuse", methods, at=sunny_sponza(), size=SMALL, reference=REFERENCE, repeats=3),
        compared("methods, glossy", methods, at=sunny_phong_sponza(), size=SMALL, reference=REFERENCE),
        *(study(f"methods, {count} lamps", few, at=lamps(count), camera=None, size=SMALL, repeats=3) for count in (1, LAMPS)),
    ]


def table(diffuse: ir.Records, glossy: ir.Records, one: ir.Records, many: ir.Records) -> pd.DataFrame:
    """A row per method: `diffuse` and `glossy`, trimmed relMSE of indirect light; `milliseconds` of a frame; `lights`, its time with eight
    lamps over that with one; `precomputed`, seconds."""
    rows = {}
    for i, name in enumerate(ways()):
        rows[name] = {
            "diffuse": diffuse[i].metrics["indirect_trimmed_relmse"],
            "glossy": glossy[i].metrics["indirect_trimmed_relmse"],
            "milliseconds": diffuse[i].milliseconds,
            "lights": many[i].milliseconds / one[i].milliseconds,
            "precomputed": diffuse[i].precompute_milliseconds / 1e3,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(*records: ir.Records) -> Figure:
    return table_figure(table(*records), f"relMSE of indirect light, milliseconds, time with {LAMPS} lamps over one, seconds before")
