"""How wide is a lobe? Light of a glossy box from caches' levels against lobes integrated over the same caches: where a level is chosen for
the solid angle within which the lobe stays above 1 % of its peak, as in the paper, and for the uniform cone of the same mean length."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.keep import NONE
from interreflect.charts.style import COLOURS, MARKERS, add_legend, dress, new_figure

EXPONENTS = (1.0, 5.0, 20.0, 50.0, 150.0, 500.0)
ROUGHNESS = (0.15, 0.3, 0.5, 0.7, 1.0)
BIAS = (-1.5, -1.0, -0.75, -0.5, 0.0)
GLOSS = {"specular": (0.4, 0.4, 0.4)}
TITLES = {"exponent": "Phong exponent", "roughness": "GGX roughness"}


def _box(**lobe: object) -> ir.Scene:
    return ir.scenes.cornell_box().replace(materials={"*": GLOSS | lobe})


boxes = {_box(lobe="phong", exponent=value): ("exponent", value) for value in EXPONENTS} | {
    _box(lobe="ggx", roughness=value): ("roughness", value) for value in ROUGHNESS
}
caching = ir.methods.ClusteredRadianceCaching(distribute=ir.Clustered(caches=1024))
study = ir.Study(
    name="how wide is a lobe?",
    scenes=list(boxes),
    methods=[
        caching.replace({"preconvolve": ir.LobeIntegral(samples=128)}),
        *ir.sweep(
            caching.replace({"preconvolve": ir.MipChain()}),
            {"preconvolve.width": ["one_percent", "resultant"], "preconvolve.level_bias": list(BIAS)},
        ),
    ],
    size=(240, 180),
    bounces=1,
    reference=NONE,
    repeats=0,
)


def table(records: ir.Records) -> pd.DataFrame:
    """A row per scene and way: `kind` and `value` of the lobe, `width`, `bias`, and `difference`: root mean squared difference of the
    indirect light from integrated lobes over its mean."""
    scenes = {box.hash: lobe for box, lobe in boxes.items()}
    exact = {record.scene_hash: np.asarray(records.images(record)[1]) for record in records if "preconvolve.width" not in record.knobs}
    rows = []
    for record in records:
        if "preconvolve.width" not in record.knobs:
            continue
        kind, value = scenes[record.scene_hash]
        image, truth = np.asarray(records.images(record)[1]), exact[record.scene_hash]
        width, bias = record.knobs["preconvolve.width"], record.knobs["preconvolve.level_bias"]
        rows.append((kind, value, width, bias, float(np.sqrt(((image - truth) ** 2).mean()) / truth.mean())))
    return pd.DataFrame(rows, columns=["kind", "value", "width", "bias", "difference"])


def chart(records: ir.Records) -> Figure:
    """Difference against exponent and roughness, a colour per bias; dashed: the lobe within 1 %."""
    found = table(records)
    kinds = list(dict.fromkeys(found["kind"]))
    figure = new_figure((4.8 * len(kinds), 4.4), dark=False)
    panels = list(figure.subplots(1, len(kinds), squeeze=False)[0])
    for axes, kind in zip(panels, kinds, strict=True):
        for (width, bias), rows in found[found["kind"] == kind].groupby(["width", "bias"]):
            i = sorted(set(found["bias"])).index(bias)
            style = {"color": COLOURS[i], "marker": MARKERS[i], "linestyle": "--" if width == "one_percent" else "-"}
            axes.plot(rows["value"], rows["difference"], label=f"{str(width).replace('_', ' ')}, {bias:+g} levels", **style)
        axes.set_xscale("log" if kind == "exponent" else "linear")
        axes.set_yscale("log")
        axes.set(xlabel=TITLES[kind], ylabel="difference from integrated lobes")
        dress(axes, dark=False)
    add_legend(figure, panels, dark=False)
    return figure
