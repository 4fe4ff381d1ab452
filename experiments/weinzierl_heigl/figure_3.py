"""Figure 3: Seeds in the light's map before and after importance warping, and the clusters that grow from them."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.light_picture import LightPicture
from experiments.shared.panels import as_share, panels, picture
from experiments.weinzierl_heigl.pipeline import MAP, replaced, study

FRAMES = 16
SEEDS = {"Halton points": "none", "warped by flux": "flux", "warped by the specular term": "specular"}


def shown(**changes: object) -> LightPicture:
    return replaced(LightPicture.preset("64 with PCSS"), **changes)  # type: ignore[no-any-return]


def studies() -> Sequence[ir.Study]:
    seeds = [shown(show="lights", cluster_lights=None, sample_lights__importance=by) for by in SEEDS.values()]
    clusters = [shown(cluster_lights__iterations=1, frames=frames) for frames in (1, FRAMES)]  # the paper's: one a frame
    return [study("seeds and clusters", [shown(show="flux", cluster_lights=None), *seeds, *clusters], size=MAP)]


def specular(records: ir.Records) -> pd.Series:
    """Share of the seeds on specular materials, by their warp; and of the map's texels."""
    counts = [record.stages["picture"]["counts"] for record in records]
    shares = {name: counts[1 + i]["specular_lights"] / counts[1 + i]["lights"] for i, name in enumerate(SEEDS)}
    return pd.Series(shares | {"texels": counts[0]["specular_texels"] / counts[0]["texels"]})


def convergence(records: ir.Records) -> pd.DataFrame:
    """A row per frame from 1 on: `distance`, root of the mean square distance of a texel to its light over the extent; `moved`, share of
    the texels that changed their light."""
    counts = records[-1].stages["picture"]["counts"]
    frames = sum(name.startswith("distance_") for name in counts)
    rows = {
        frame + 1: {
            "distance": counts[f"distance_{frame}"] / 1e6,
            "moved": counts.get(f"moved_{frame}", counts["texels"]) / counts["texels"],
        }
        for frame in range(frames)
    }
    return pd.DataFrame.from_dict(rows, orient="index")


def chart(records: ir.Records) -> Figure:
    share, steps = specular(records), convergence(records)
    last = len(steps)
    names = [
        f"what the light sees, {share['texels']:.0%} specular",
        *(f"{name}, {share[name]:.0%} on specular" for name in SEEDS),
        f"clusters after 1 frame: texels {steps['distance'].iloc[0]:.3f} of the extent from their light",
        f"after {last}: {steps['distance'].iloc[-1]:.3f}, {steps['moved'].iloc[-1]:.1%} of the texels still move",
    ]
    return panels([(name, as_share(picture(records, i))) for i, name in enumerate(names)], columns=3)
