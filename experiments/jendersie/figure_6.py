"""Figure 6: Indirect diffuse light of Sponza by composition, by voxel cones, and by light propagation, beside the truth."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.jendersie.pipeline import GRID, SMALL, compared, composition, difference, indirect
from experiments.shared.panels import as_light, panels
from experiments.shared.scenes import sunny_sponza

OURS = "composition, setting 1"
NEARER = "composition, rays to what is near"  # and pixels look before their surfaces
RIVALS = ("voxel cones, grid of 128", "light propagation, grid of 32")
REFERENCE = ir.Reference(noise=2e-3, max_spp=512)


def ways() -> dict[str, Any]:
    return {
        OURS: composition(),
        NEARER: composition(link__near_rays=512, place_caches=ir.LightMap(texels=128, grid=GRID.replace(normal_offset=0.25))),
        RIVALS[0]: ir.methods.VoxelConeTracing().replace({"grid.resolution": 128}),
        RIVALS[1]: ir.methods.LightPropagationVolumes(),
    }


def studies() -> Sequence[ir.Study]:
    """One bounce of all, as cones have no more; and all bounces of composition."""
    scene = sunny_sponza()
    return [
        compared("one diffuse bounce", list(ways().values()), at=scene, size=SMALL, reference=REFERENCE, repeats=2),
        compared("all diffuse bounces", [composition(bounces=None)], at=scene, size=SMALL, bounces=None, reference=REFERENCE),
    ]


def table(one: ir.Records, every: ir.Records) -> pd.DataFrame:
    """A row per way: of the indirect light `off`, relative, `energy` over the truth's, trimmed `relmse`; and a frame's `milliseconds`."""
    named = [*((name, one, i) for i, name in enumerate(ways())), ("composition, all bounces", every, 0)]
    rows = {}
    for name, records, i in named:
        truth, ours = np.asarray(records.truth(records[i])[1]), indirect(records, i)
        rows[name] = {
            "off": difference(ours, truth),
            "energy": float(ir.metrics.energy_ratio(ours, truth)),
            "relmse": records[i].metrics["indirect_trimmed_relmse"],
            "milliseconds": records[i].milliseconds,
        }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(one: ir.Records, every: ir.Records) -> Figure:
    found = table(one, every)
    truth, all_of_it = (np.asarray(records.truth(records[0])[1]) for records in (one, every))

    def named(name: str) -> str:
        row = found.loc[name]
        return f"{name}: {row['off']:.0%} off, energy {row['energy']:.2f}"

    names = list(ways())
    shown = [(named(name), as_light(indirect(one, i), truth)) for i, name in enumerate(names)]
    return panels(
        [
            *shown,
            ("path-traced truth, one bounce", as_light(truth, truth)),
            (named("composition, all bounces"), as_light(indirect(every, 0), all_of_it)),
            ("path-traced truth, all bounces", as_light(all_of_it, all_of_it)),
        ]
    )
