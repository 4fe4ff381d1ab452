"""Figure 5: The buffers of a frame's lighting, from the light's map to the whole picture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

import interreflect as ir
from experiments.shared.light_picture import LightPicture
from experiments.shared.panels import as_light, as_share, groups, picture
from experiments.shared.split_picture import SplitPicture
from experiments.weinzierl_heigl.pipeline import MAP, area_lights, compared, indirect, replaced, study


def studies() -> Sequence[ir.Study]:
    maps = [replaced(LightPicture.preset("64 with PCSS"), show=show) for show in ("flux", "clusters")]
    return [
        study("the light's buffers", maps, size=MAP),
        study("split buffer", [SplitPicture(share=ir.Interleaved(width=4, height=4))]),
        compared("lighting chain", [area_lights(), area_lights(share=ir.EveryPixel())]),
    ]


def chart(maps: ir.Records, split: ir.Records, light: ir.Records) -> Figure:
    whole, of_indirect = (np.asarray(one) for one in light.truth(light[0]))
    image, merged = (np.asarray(one) for one in light.images(light[0]))
    return groups(
        {
            "the light's map": [
                ("flux that it sends on", as_share(picture(maps, 0))),
                ("64 clusters", as_share(picture(maps, 1))),
            ],
            "the picture's": [
                ("split buffer: normals of each phase's pixels", as_share(picture(split))),
                ("direct light", as_light(image - merged, whole)),
                ("indirect light, a sixteenth of the lights a pixel, merged and filtered", as_light(merged, of_indirect)),
                ("indirect light, all lights at every pixel", as_light(indirect(light, 1), of_indirect)),
                ("all light", as_light(image, whole)),
                ("path-traced truth, one bounce", as_light(whole, whole)),
            ],
        }
    )
